"""What the theory knows of each friction section, a file each; `listed` is the list."""
