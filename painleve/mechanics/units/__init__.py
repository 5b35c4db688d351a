"""Whether the units that a scene states agree with its formulas; `check` is the way in, `dimension` the arithmetic."""
