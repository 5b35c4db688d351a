"""Which route finds which published fact."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from types import MappingProxyType

from painleve.errors import InputError
from studies.reference import contact, impacts, rod, slips
from studies.reference.compare import FoundValue, Reproduction, compare
from studies.reference.facts import Fact

__all__ = ["ROUTES", "reproduce"]

# quick: fewer random states, slips and stiffnesses; seed: of the random states
ROUTES: Mapping[str, Callable[[bool, int], FoundValue]] = MappingProxyType(
    {
        "least_friction": lambda quick, seed: rod.find_least_friction(slope=False),
        "least_friction_slope": lambda quick, seed: rod.find_least_friction(slope=True),
        "mu_P": lambda quick, seed: rod.find_mu_P(slope=False),
        "mu_P_slope": lambda quick, seed: rod.find_mu_P(slope=True),
        "lower_band_edge": lambda quick, seed: rod.find_band_edge(upper=False),
        "upper_band_edge": lambda quick, seed: rod.find_band_edge(upper=True),
        "sixty_degrees_friction": lambda quick, seed: rod.find_sixty_degrees_friction(),
        "force_at_rest": lambda quick, seed: rod.find_force_at_rest(),
        "jean_condition": lambda quick, seed: contact.find_jean_condition(quick=quick, seed=seed),
        "regime_slip": lambda quick, seed: contact.find_regime("0", "1", quick=quick, seed=seed),
        "regime_lift_off": lambda quick, seed: contact.find_regime("6", "1", quick=quick, seed=seed),
        "regime_inconsistent": lambda quick, seed: contact.find_regime("0", "2", quick=quick, seed=seed),
        "regime_indeterminate": lambda quick, seed: contact.find_regime("6", "2", quick=quick, seed=seed),
        "singular_rate": lambda quick, seed: rod.find_singular_rate(),
        "eigenvalue_ratio": lambda quick, seed: rod.find_eigenvalue_ratio(),
        "mu_C": lambda quick, seed: rod.find_mu_C(uniform=False),
        "mu_C_uniform": lambda quick, seed: rod.find_mu_C(uniform=True),
        "bounded_force": lambda quick, seed: slips.find_bounded_force(quick=quick),
        "infinite_force": lambda quick, seed: slips.find_infinite_force(quick=quick),
        "inconsistent_not_reached": lambda quick, seed: slips.find_inconsistent_not_reached(quick=quick),
        "stoss_angle": lambda quick, seed: slips.find_stoss_angle(),
        "stoss_time": lambda quick, seed: slips.find_stoss_time(),
        "impact_ends_in_stick": lambda quick, seed: impacts.find_impact_ends_in_stick(quick=quick),
        "impact_must_follow": lambda quick, seed: impacts.find_impact_must_follow(quick=quick),
        "stewart_45": lambda quick, seed: contact.find_stewart_start("pi/4", "-1"),
        "stewart_135": lambda quick, seed: contact.find_stewart_start("3*pi/4", "1"),
        "stewart_rest": lambda quick, seed: impacts.find_stewart_rest(),
    }
)


def reproduce(
    facts: Iterable[Fact], *, quick: bool = False, seed: int = 0, progress: Callable[[str], None] | None = None
) -> tuple[Reproduction, ...]:
    """Every fact by its route, in order; `progress` gets each id when it is done. Raises InputError without a route."""
    found = []
    for fact in facts:
        if fact.id not in ROUTES:
            raise InputError(f"fact {fact.id}: there is no route to it; there are routes to {', '.join(ROUTES)}")
        found.append(compare(fact, ROUTES[fact.id](quick, seed)))
        if progress is not None:
            progress(fact.id)
    return tuple(found)
