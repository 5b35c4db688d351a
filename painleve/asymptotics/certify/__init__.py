"""Rigorous enclosures of both excesses; `method` is the way in.

A_eps is written as images of boxes (`pieces`, with `taylor_models` over a `cover` of the offsets), bounded by
`branch_and_bound`, with true members from `preimage`; `isolation` is for isolated critical states.
"""
