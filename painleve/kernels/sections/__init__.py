"""What the kernels know of each friction section, a file each: its rows, the text of its law; `listed` is the list."""
