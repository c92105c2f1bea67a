"""Multi-rocking-body dynamics of unreinforced masonry walls that may fall out of their plane.

A façade cracked at mid-height rocks as two stacked rigid bodies, held at the top by a flexible floor. Names and units
are those of the wall file and of the result files: SI, with the unit in the name.

>>> wall = Wall(thickness_m=0.3, height_m=4.0, crack_height_m=2.2, length_m=1.5, density_kg_m3=1800.0)
>>> wall.describe()["opening"]["ground_g"] < 0.1
True
"""

from mrbd import records
from mrbd._asked import Assessment, Margin, Push, Risk, assess, margin, push, risk
from mrbd._fragility import Fragility, fragility
from mrbd._laboratory import Calibration, Diagnosis, calibrate, diagnose
from mrbd._many import simulate_many
from mrbd._mrbd import (
    Error,
    InputError,
    Interrupted,
    Question,
    Record,
    Run,
    Table,
    Wall,
    effects,
    simulate,
)
from mrbd._parts import PATTERNS, Diaphragm
from mrbd._study import Study, study

__all__ = [
    "PATTERNS",
    "Assessment",
    "Calibration",
    "Diagnosis",
    "Diaphragm",
    "Error",
    "Fragility",
    "InputError",
    "Interrupted",
    "Margin",
    "Push",
    "Question",
    "Record",
    "Risk",
    "Run",
    "Study",
    "Table",
    "Wall",
    "assess",
    "calibrate",
    "diagnose",
    "effects",
    "fragility",
    "margin",
    "push",
    "records",
    "risk",
    "simulate",
    "simulate_many",
    "study",
]
