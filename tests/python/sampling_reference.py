"""Reference points of the Sobol sequence, by scipy.

    python -m venv venv && venv/bin/pip install scipy
    venv/bin/python sampling_reference.py

scipy takes the points in the order of the Gray code; point n of it is point n ^ (n >> 1) of the plain order.
"""

import scipy
from scipy.stats import qmc

print("scipy", scipy.__version__)
points = qmc.Sobol(40, scramble=False, bits=32).random_base2(14)
for n in (5, 10, 9999):
    print(n ^ (n >> 1), [repr(float(x)) for x in points[n]])
