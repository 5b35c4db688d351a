"""The paper's hypotheses (H1), (H2), (H3), (H4) and (H'4) on a ball around a state, one check each."""
