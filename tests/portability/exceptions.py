"""Inputs to check for floating-point exceptions: ordinary postures and difficult ones."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from closedform.check.samples import Sample, inverse_postures, joint_samples, perturbed

from .driver import Request, derivation, numpy_values

HUGE = "huge"  # beyond 1e11 libm computes the sines, but only after polynomials that overflow


def requests(robot: str, *, single: bool) -> Iterator[Request]:
    """Targets in and out of reach, on the boundary and on singular sets; joints of every kind."""
    d = derivation(robot)
    inverses = {i.function: i for i in d.inverses}
    for function in d.functions:
        size = sum(a.size for a in function.inputs)
        inverse = inverses.get(function.name)
        if inverse is not None and (inverse.images or inverse.targets == function.symbols):
            forward = d[inverse.images or "fk"]
            for sample in inverse_postures(d, inverse.unknowns):
                images = numpy_values(robot, forward, sample.values, sample.parameters)[0]
                images = images[np.isfinite(images).all(axis=1)]
                if not len(images) or images.shape[1] % size:
                    continue
                targets = images.reshape(-1, size)
                for rows in (targets, perturbed(targets), 3 * targets):
                    yield _request(robot, function.name, sample, rows, single)
        else:
            for sample in joint_samples(d, function):
                if sample.name != HUGE and sample.values.shape[1] == size:
                    yield _request(robot, function.name, sample, sample.values, single)


def _request(robot: str, name: str, sample: Sample, rows: np.ndarray, single: bool) -> Request:
    parameters = np.array(sample.parameters)
    if single:
        with np.errstate(under="ignore"):
            rows, parameters = (v.astype(np.float32).astype(float) for v in (rows, parameters))
    return Request((robot, name), tuple(parameters.tolist()), rows)
