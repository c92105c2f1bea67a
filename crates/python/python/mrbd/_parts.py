"""Parts of a wall, and names."""

from dataclasses import dataclass

PATTERNS = ("rest", "1a", "2a", "3a", "4a", "1b", "2b", "3b", "4b")
"""Patterns of contact (the paper's Fig. 4) in the order of `Run.pattern_index`."""


@dataclass(frozen=True)
class Diaphragm:
    """Floor or roof at the top: the section `[diaphragm]` of a wall file."""

    mass_kg: float
    """Mass m_d that acts in both directions."""
    stiffness_n_per_m: float
    """Stiffness k_d of the spring."""
    carriage_mass_kg: float = 0.0
    """Mass m_dp that acts horizontally only."""
    eccentricity_m: float = 0.0
    """Horizontal offset e_C of masses and spring."""
