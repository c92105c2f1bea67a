"""Does OpenQuake read a fragility model, and does it mean the same curve?

    python -m venv venv && venv/bin/pip install openquake.engine
    mrbd fragility granite_outcomes.csv --intensity 'pga_g*9.80665*pgv_over_pga_s' --outcome sp1_overturned \\
        --nrml model.xml --imt PGV --imt-factor 100
    venv/bin/python openquake_reads.py model.xml MEDIAN BETA

with the median in OpenQuake's unit. With openquake.engine 3.26.2 the largest difference was 3e-10.
"""

import sys

import numpy as np
from openquake.hazardlib import nrml
from openquake.risklib.scientific import FragilityFunctionContinuous
from scipy.stats import norm

path, median, beta = sys.argv[1], float(sys.argv[2]), float(sys.argv[3])
for key, functions in nrml.to_python(path).items():
    mean, stddev = functions.array[0]
    function = FragilityFunctionContinuous("collapse", mean, stddev, 0, np.inf, 0)
    x = median * np.exp(beta * np.linspace(-3, 3, 61))
    print(key, functions, "largest difference", np.abs(function(x) - norm.cdf(np.log(x / median) / beta)).max())
