"""What several studies measure with: timed records, the naive baseline, error against work."""
