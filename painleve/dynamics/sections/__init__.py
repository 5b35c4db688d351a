"""What the dynamics know of each friction section, a file each; `listed` is the list."""
