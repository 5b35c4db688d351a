# ---
# jupyter:
#   jupytext:
#     text_representation:
#       extension: .py
#       format_name: percent
#   kernelspec:
#     display_name: Python 3
#     language: python
#     name: python3
# ---

# %% [markdown]
# # A tour: Painlevé's paradox in the limit
#
# A rod slides on a rough floor. Push small balls of radius ε around its state through the contact law of a
# time-stepping scheme, and look at the velocities $A_\varepsilon$ that come out. First the picture, then what it means.

# %%
# %matplotlib inline
import numpy as np

import painleve
from painleve.sweep import map_gamma, map_regimes, sweep_members

rod = painleve.load_scene("slender_rod")
painleve.draw(sweep_members(rod, eps=[1e-1], states=["paradox", "critical"]))

# %% [markdown]
# Left and right are the two velocities between which Coulomb's law cannot choose: $u^-$, sliding on, and $\tilde u$, a
# jump to sticking, though nothing has collided. In the state `critical` the whole segment between them is filled.
#
# ## The rod, derived
#
# Everything follows from the kinetic energy, the constraint $g(q) \le 0$ and the friction section. With
# $w_n = -\nabla g$ and $H$ the gradient of the tip's tangential displacement, $a = w_n^\top M^{-1} w_n$ and
# $b = w_n^\top M^{-1} H$; the sign of $\gamma = (a - \mu |b|)/\|\nabla g\|^2$ decides, and $\mu_c = a/|b|$ is the
# critical friction.

# %%
derivation = painleve.derive(rod)
print(rod.inertia, derivation.a.simplify(), derivation.couplings[0].simplify(), sep="\n")

# %%
painleve.draw(map_gamma(rod, states=[state.name for state in rod.states]))

# %% [markdown]
# ## Four regimes
#
# While the tip slides, the contact force $F$ solves $0 \le F \perp \beta + pF \ge 0$, with $\beta$ the free normal
# acceleration and $p$ the normal compliance in the sense of the slip. The signs of the two make four regimes: slip,
# lift-off, none (*inconsistent*: no acceleration solves it) and two (*indeterminate*).

# %%
axes = {"theta": np.linspace(0.2, 1.5, 120), "omega": np.linspace(0.0, 6.0, 100)}
painleve.draw(map_regimes(rod, axes=axes, parameters={"mu": 2}))

# %% [markdown]
# ## The branches of Theorem 1
#
# A statement such as $\gamma = 0$ is not one that floating point can make. States are exact, and so is the branch.

# %%
for state in rod.states:
    classification = painleve.classify(painleve.make_state(rod, state.name))
    print(f"{state.name:12} {classification.branch.value:20} {classification.statement}")

# %% [markdown]
# Distances against ε: a sample consists of true members of $A_\varepsilon$, so it bounds $e(A_\varepsilon, A)$ from
# below (▲) and $e(A, A_\varepsilon)$ from above (▼), and proves nothing else. In `double_zero` hardly any sample slips,
# and the sampled bound gets *worse* as ε falls. The theorem is right: witnesses (▽), built as in its proof, show it.

# %%
distances = painleve.sweep_distances(
    rod, eps=np.logspace(-1, -5, 5), states=["paradox", "double_zero"], options=painleve.SampleOptions(samples=50_000)
)
painleve.draw(distances)

# %% [markdown]
# A witness for the middle of the segment: a pair $(q_\varepsilon, v_\varepsilon)$ in the balls whose image is nearly
# there, with an enclosure of its distance.

# %%
limit = painleve.limit_set(painleve.make_state(rod, "double_zero"))
witness = painleve.find_witness(limit, 0.5, 1e-6, within=1e-9)
print(witness.reason, witness.distance, witness.member.branch.label, sep="\n")

# %% [markdown]
# With constant friction a rod shows only the first two branches. Wear the tip, so that μ depends on θ, and the critical
# state can be isolated: then $A_\varepsilon$ tends to the two ends alone, and half the segment stays away.

# %%
worn = painleve.load_scene("worn_tip_rod")
painleve.draw(sweep_members(worn, eps=[1e-2], states=["approached", "isolated"]))
