"""The compiled motion of a scene: its functions, and templates of what is the same for every scene.

The templates are the modules `tuples`, `contact`, `loops`, and those of `sections` and `schemes`: Python that runs as
it stands, without compiler, on the scene of `sample`. `source` writes them out for another scene.
"""
