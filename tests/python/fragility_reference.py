"""Reference values of the fragility tests, by statsmodels and scipy.

    python -m venv venv && venv/bin/pip install statsmodels scipy
    venv/bin/python fragility_reference.py [granite_outcomes.csv]

Nothing here shares code with the program.
"""

import csv
import sys

import numpy as np
import scipy
import statsmodels
import statsmodels.api as sm
from scipy import optimize, stats


def probit(x, k, n):
    """Median, beta, log-likelihood without binomial coefficients, standard errors of ln median and beta."""
    x, k, n = (np.asarray(v, float) for v in (x, k, n))
    design = sm.add_constant(np.log(x))
    model = sm.GLM(np.column_stack([k, n - k]), design,
                   family=sm.families.Binomial(link=sm.families.links.Probit()))
    fit = model.fit(method="newton", tol=1e-14, maxiter=200)
    a, b = fit.params
    eta = design @ fit.params
    value = np.sum(k * stats.norm.logcdf(eta) + (n - k) * stats.norm.logcdf(-eta))
    covariance = np.linalg.inv(-model.hessian(fit.params, observed=True))
    of_median = np.array([-1 / b, a / b**2])
    of_beta = np.array([0, -1 / b**2])
    errors = [np.sqrt(g @ covariance @ g) for g in (of_median, of_beta)]
    return np.exp(-a / b), 1 / b, value, *errors


def profile(x, k, n, level=0.95):
    """Profile-likelihood bounds of median and beta."""
    x, k, n = np.log(np.asarray(x, float)), np.asarray(k, float), np.asarray(n, float)

    def value(t, s):
        z = (x - t) * np.exp(-s)
        return -np.sum(k * stats.norm.logcdf(z) + (n - k) * stats.norm.logcdf(-z))

    best = optimize.minimize(lambda p: value(*p), [x.mean(), -1.0], method="Nelder-Mead",
                             options=dict(xatol=1e-12, fatol=1e-14, maxiter=10000))
    limit = best.fun + stats.chi2.ppf(level, 1) / 2
    over_s = lambda t: optimize.minimize_scalar(lambda s: value(t, s), bounds=(-6, 6), method="bounded",
                                                options=dict(xatol=1e-12)).fun - limit
    over_t = lambda s: optimize.minimize_scalar(lambda t: value(t, s), bounds=(-6, 6), method="bounded",
                                                options=dict(xatol=1e-12)).fun - limit
    t, s = best.x
    bounds = [optimize.brentq(over_s, t - 2, t), optimize.brentq(over_s, t, t + 2)]
    bounds += [optimize.brentq(over_t, s - 2, s), optimize.brentq(over_t, s, s + 2)]
    return np.exp(bounds)


def censored(values, stood):
    """Median and beta of log-normal collapse intensities, some only known to lie above."""
    values, stood = np.log(values), np.log(stood)

    def minus(p):
        t, s = p[0], np.exp(p[1])
        return -(np.sum(stats.norm.logpdf(values, t, s)) + np.sum(stats.norm.logsf(stood, t, s)))

    best = optimize.minimize(minus, [values.mean(), -1.0], method="Nelder-Mead",
                             options=dict(xatol=1e-13, fatol=1e-15, maxiter=10000))
    return np.exp(best.x[0]), np.exp(best.x[1]), -best.fun


def auc(x, y):
    """Area under the ROC curve as the Mann-Whitney statistic."""
    x, y = np.asarray(x), np.asarray(y, bool)
    return stats.mannwhitneyu(x[y], x[~y]).statistic / (y.sum() * (~y).sum())


def show(name, values):
    print(f"{name}: " + ", ".join(f"{float(v):.12g}" for v in np.atleast_1d(values)))


def main():
    print("numpy", np.__version__, "scipy", scipy.__version__, "statsmodels", statsmodels.__version__)
    stripes = ([0.2, 0.4, 0.6, 0.8, 1.0, 1.5], [0, 2, 8, 17, 24, 36], [40] * 6)
    show("stripes", probit(*stripes))
    show("stripes profile", profile(*stripes))
    show("censored", censored([0.31, 0.44, 0.52, 0.58, 0.73, 0.81, 0.97], [1.0, 1.0, 1.0]))
    # Cloud: regression of ln demand on ln intensity.
    x = np.log([0.1, 0.15, 0.2, 0.3, 0.45, 0.6, 0.8])
    y = np.log([0.012, 0.03, 0.02, 0.06, 0.05, 0.14, 0.12])
    line = sm.OLS(y, sm.add_constant(x)).fit()
    a, b = line.params
    s = np.sqrt(line.scale)
    show("cloud at 0.1", [a, b, s, np.exp((np.log(0.1) - a) / b), s / b])
    # Bivariate normal minus product of the margins.
    joint = [stats.multivariate_normal.cdf([h, k], [0, 0], [[1, r], [r, 1]], abseps=1e-12, releps=1e-12)
             - stats.norm.cdf(h) * stats.norm.cdf(k) for h, k, r in ((0.3, -0.7, 0.4), (-1.5, 0.2, 0.9))]
    show("joint", joint)
    if len(sys.argv) > 1:
        rows = list(csv.DictReader(open(sys.argv[1])))
        pga = np.array([float(r["pga_g"]) for r in rows])
        pgv = pga * 9.80665 * np.array([float(r["pgv_over_pga_s"]) for r in rows])
        for column in ("sp1_overturned", "sp2_overturned"):
            y = np.array([float(r[column]) for r in rows])
            show(column + " pgv", [*probit(pgv, y, np.ones_like(y)), auc(pgv, y)])
            show(column + " pga", [*probit(pga, y, np.ones_like(y)), auc(pga, y)])
            null = y.mean()
            show(column + " null log-likelihood", np.sum(stats.bernoulli.logpmf(y.astype(int), null)))


if __name__ == "__main__":
    main()
