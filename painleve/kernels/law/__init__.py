"""The compiled law of a scene through blocks of samples: templates of what is the same for every scene.

`lane` runs as it stands, without compiler, on the scene of `sample`; painleve.kernels.source writes it out for others.
"""
