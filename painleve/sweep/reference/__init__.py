"""Published facts, each found again by a route that does not use the published formula."""

from painleve.sweep.reference.compare import FactStatus, Reproduction
from painleve.sweep.reference.dataset import as_dataset
from painleve.sweep.reference.facts import load_facts
from painleve.sweep.reference.routes import reproduce

__all__ = ["FactStatus", "Reproduction", "as_dataset", "load_facts", "reproduce"]
