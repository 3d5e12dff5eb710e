"""PyTorch, JAX and Dask with the modules for any array library, each if it is installed."""

from __future__ import annotations

from places import ROOT
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from closedform.generated.array import hybrid_five_bar, planar_2r, puma560, spherical_wrist
from closedform.generated.numpy import planar_2r as reference
from closedform.generated.numpy import puma560 as arm
from closedform.generated.numpy import spherical_wrist as wrist

GUIDE = ROOT / "docs" / "using.md"
POSTURES = np.random.default_rng(4).uniform(-2, 2, (6, 2))
TARGETS = np.concatenate([reference.fk(POSTURES), [[40.0, 0.0], [np.nan, 1.0], [18.0, 0.0]]])


@pytest.fixture
def jax() -> Iterator[Any]:
    jax = pytest.importorskip("jax", reason="JAX is not installed")
    with jax.enable_x64(True):
        yield jax


@pytest.fixture
def torch() -> Any:
    return pytest.importorskip("torch", reason="PyTorch is not installed")


@pytest.fixture
def dask() -> Any:
    return pytest.importorskip("dask.array", reason="Dask is not installed")


@pytest.mark.parametrize("library", ["jax", "torch", "dask"])
def test_the_examples_of_the_guide(library: str, request: pytest.FixtureRequest) -> None:
    request.getfixturevalue(library)
    found = re.findall(rf"^```python {library}\n(.*?)^```", GUIDE.read_text("utf-8"), re.M | re.S)
    assert len(found) == 1
    names: dict[str, Any] = {}
    exec(found[0], names)
    if library == "torch":
        assert np.isfinite(names["x"].grad.numpy()).all()
    if library == "jax":
        gradient = names["jax"].grad(names["effort"])(names["arm"])
        for k, name in enumerate(gradient._fields):
            step = np.eye(2)[k] * 1e-6
            ends = [
                names["effort"](planar_2r.Parameters(*(np.array(names["arm"]) + s * step)))
                for s in (1, -1)
            ]
            assert float(getattr(gradient, name)) == pytest.approx(
                float(ends[0] - ends[1]) / 2e-6, rel=1e-5
            )


def test_jax_compiles_maps_and_differentiates(jax: Any) -> None:
    q = jax.numpy.asarray(POSTURES)
    expected = reference.jacobian(POSTURES)[:, :2]
    for derivative in (jax.jacfwd, jax.jacrev):
        found = jax.jit(jax.vmap(derivative(planar_2r.fk)))(q)
        np.testing.assert_allclose(found, expected, atol=1e-13)
    solved, known = jax.jit(planar_2r.ik)(jax.numpy.asarray(TARGETS)), reference.ik(TARGETS)
    np.testing.assert_array_equal(solved.status, known.status)
    np.testing.assert_allclose(solved.q, known.q, atol=1e-7)
    by_target = jax.jit(jax.jacrev(lambda x: planar_2r.ik(x).q))(jax.numpy.asarray(TARGETS[0]))
    for branch, rates in zip(known.q[0], by_target, strict=True):
        np.testing.assert_allclose(rates @ reference.jacobian(branch)[:2], np.eye(2), atol=1e-9)
    turned = wrist.fk([[0.4, 0.5, 0.6], [0.1, -0.2, 0.3]])
    found = jax.jit(spherical_wrist.ik)(jax.numpy.asarray(turned))
    np.testing.assert_allclose(found.q, wrist.ik(turned).q, atol=1e-12)


def test_jax_differentiates_by_dimensions(jax: Any) -> None:
    """Over a batch with targets that are out of reach, singular and not finite."""
    x = jax.numpy.asarray(TARGETS)

    def total(dimensions: Any) -> Any:
        q, status = planar_2r.ik(x, dimensions)
        return jax.numpy.where((status == 0)[..., None], q, 0.0)[:-3].sum()

    total = jax.jit(total)
    found = jax.grad(total)(planar_2r.Parameters())
    assert isinstance(found, planar_2r.Parameters) and np.isfinite(np.array(found)).all()
    differences = [
        (total((10.0 + a, 8.0 + b)) - total((10.0 - a, 8.0 - b))) / 2e-6
        for a, b in ((1e-6, 0.0), (0.0, 1e-6))
    ]
    np.testing.assert_allclose(np.array(found), np.array(differences), rtol=1e-5, atol=1e-7)


def test_torch_differentiates_and_maps(torch: Any) -> None:
    q = torch.asarray(POSTURES)
    expected = reference.jacobian(POSTURES)[:, :2]
    for derivative in (torch.func.jacfwd, torch.func.jacrev):
        found = torch.func.vmap(derivative(planar_2r.fk))(q)
        np.testing.assert_allclose(found.numpy(), expected, atol=1e-13)
    target = torch.asarray(arm.fk([0.3, -0.9, 0.8, 0.4, 0.7, -0.2])).requires_grad_()
    solved = puma560.ik(target)
    known = arm.ik(target.detach().numpy())
    np.testing.assert_array_equal(solved.status.numpy(), known.status)
    np.testing.assert_allclose(solved.q.detach().numpy(), known.q, atol=1e-12)
    (rate,) = torch.autograd.grad(solved.q[0, 2], target)
    step = 1e-6 * np.eye(6)
    moved = (arm.fk(known.q[0] + step) - arm.fk(known.q[0] - step)) / 2e-6
    np.testing.assert_allclose(np.tensordot(moved, rate.numpy(), 2), np.eye(6)[2], atol=1e-8)


def test_torch_by_dimensions_and_in_single_precision(torch: Any) -> None:
    l1 = torch.tensor(10.0, requires_grad=True)
    x = torch.asarray(TARGETS, dtype=torch.float32)
    q, status = planar_2r.ik(x, planar_2r.Parameters(l1=l1))
    assert q.dtype == torch.float32 and status.dtype == torch.uint8
    torch.where((status == 0)[..., None], q, 0.0).sum().backward()
    assert torch.isfinite(l1.grad)


@pytest.mark.filterwarnings("ignore")
def test_torch_compiles_without_a_break(torch: Any) -> None:
    compiled = torch.compile(planar_2r.fk, backend="eager", fullgraph=True)
    np.testing.assert_allclose(compiled(torch.asarray(POSTURES)).numpy(), reference.fk(POSTURES))


def test_dask_evaluates_chunk_by_chunk(dask: Any) -> None:
    x = dask.from_array(TARGETS, chunks=(4, 2))
    found, known = planar_2r.ik(x), reference.ik(TARGETS)
    assert found.q.chunks == ((4, 4, 1), (2,), (2,)) and found.status.dtype == np.uint8
    np.testing.assert_array_equal(found.status.compute(), known.status)
    np.testing.assert_allclose(found.q.compute(), known.q, atol=1e-12)
    l1 = dask.linspace(9, 11, len(TARGETS), chunks=4)
    by_length = planar_2r.fk(known.q[:, 0] * 0.0 + 0.1, (np.asarray(l1), 8.0))
    q = dask.from_array(known.q[:, 0] * 0.0 + 0.1, chunks=(4, 2))
    np.testing.assert_allclose(planar_2r.fk(q, (l1, 8.0)).compute(), by_length)
    inside = hybrid_five_bar.workspace_contains(dask.zeros((6, 3), chunks=(2, 3)))
    assert inside.dtype == np.bool_ and inside.compute().shape == (6,)
