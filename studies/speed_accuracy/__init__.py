"""The error in d_H(A, A_eps) that each method leaves, and what it costs."""
