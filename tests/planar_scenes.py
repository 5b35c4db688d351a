"""The scenes on which every method is tested in full: each kind of critical state, with and without constant M."""

SCENE_NAMES = ("slender_rod", "worn_tip_rod", "two_link_arm")
