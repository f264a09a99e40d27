"""A parallel batch probability engine for the basketball shot.

>>> import bankshot
>>> guard = bankshot.Profile(
...     name="guard", release_height="7 ft", max_backspin="3 rev/s",
...     errors={"speed": "0.25 ft/s", "pitch": "1.2 deg", "polar": "1.22 deg", "backspin": "0.3 rev/s"},
...     distance="13.75 ft", physics="ncaa",
... )
>>> p = guard.probability(speed="24.3 ft/s", pitch_deg=54.3, backspin_rev_s=3, target=0.002)
>>> round(p.probability, 2)
0.77

Floats are in the unit that their name says (``speed_ft_s=23.6``); text has its unit
(``speed="23.6 ft/s"``); pint quantities are understood.
"""

from ._commands import BankshotError, BankshotWarning
from ._engine import OUTCOME_KINDS, InputError, __version__
from ._measured import Advice, Estimate, Fit, Parameter, advise, fit
from ._profile import Physics, Profile
from ._shots import BestShot, BestShots, Probability, Trace
from ._simulate import simulate
from ._sweep import Comparison, Sweep, compare, sweep


def probability(profile: Profile, **shot: object) -> Probability:
    """P of one nominal shot: :meth:`Profile.probability`."""
    return profile.probability(**shot)  # type: ignore[arg-type]


def best(profile: Profile, **options: object) -> BestShots:
    """The best direct and bank shots: :meth:`Profile.best`."""
    return profile.best(**options)  # type: ignore[arg-type]


def trace(profile: Profile, **shot: object) -> Trace:
    """The path of one shot without errors: :meth:`Profile.trace`."""
    return profile.trace(**shot)  # type: ignore[arg-type]


__all__ = [
    "Advice",
    "BankshotError",
    "BankshotWarning",
    "BestShot",
    "BestShots",
    "Comparison",
    "Estimate",
    "Fit",
    "InputError",
    "OUTCOME_KINDS",
    "Parameter",
    "Physics",
    "Probability",
    "Profile",
    "Sweep",
    "Trace",
    "__version__",
    "advise",
    "best",
    "compare",
    "fit",
    "probability",
    "simulate",
    "sweep",
    "trace",
]
