"""Datasets to HDF5 and back: never half a file, never a variable without a unit and a sentence.

Files are written through h5netcdf, so that `xarray.open_dataset(path, engine="h5netcdf")` reads them without this
package. A file is made in memory, written aside, flushed to the disk and moved into place: who stops the program at any
moment finds the old file or the new one. What is read is checked first: its digest, how it is built, and its schema.
"""

from painleve.store.layout import hold_to_layout
from painleve.store.origin import PROVENANCE, provenance
from painleve.store.read import load
from painleve.store.schema import NOT_RUN, check_schema, flags, labels_of
from painleve.store.write import check_output, check_writable, save

__all__ = [
    "NOT_RUN",
    "PROVENANCE",
    "check_output",
    "check_schema",
    "check_writable",
    "flags",
    "hold_to_layout",
    "labels_of",
    "load",
    "provenance",
    "save",
]
