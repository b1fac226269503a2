"""A controller's rows in Python: the formulas of docs/control.md, what is refused, what was found at each row."""
import math
import os
import pathlib
import sys
import threading
import time
from typing import Any, Callable

import numpy as np
import pytest

import fcl_stpbv

DATA = pathlib.Path(os.environ.get("FCL_STPBV_DATA", pathlib.Path(__file__).parents[2] / "data"))
FILES = DATA / "hrp2_style/hrp2_style.urdf", DATA / "hrp2_style/hrp2_style.srdf"
D_I, D_S, XI, GAIN, PERIOD = 0.06, 0.015, 0.4, 30.0, 2e-3


@pytest.fixture(scope="module")
def robot():
    return fcl_stpbv.Robot(*FILES)


def damper_of(robot, **more):
    given: dict[str, Any] = dict(influence=D_I, security=D_S, damping=XI, period=PERIOD, barrier_gain=GAIN)
    return fcl_stpbv.VelocityDamper(robot, **{**given, **more})


def postures(robot, seed, count):
    random = np.random.default_rng(seed)
    for _ in range(count):
        yield random.uniform(robot.lower, robot.upper), random.normal(size=len(robot.names))


def test_rows_at_each_level_are_those_of_the_page(robot):
    own = {row: (0.2, 0.05, 0.7) for row in range(0, len(robot.rows), 7)}
    d_i, d_s, xi = (np.array([own.get(row, (D_I, D_S, XI))[k] for row in range(len(robot.rows))]) for k in range(3))
    a = xi / (d_i - d_s)
    dampers = {level: damper_of(robot, level=level, rows=own, headroom=-1) for level in ("velocity", "acceleration", "barrier")}
    seen = 0
    for q, qd in postures(robot, 1, 20):
        d, J, speed, drift = robot.rates(q, qd)
        shallow = d > -0.02  # both margins; deeper answers may depend on where the search starts
        bounds = {"velocity": -a * (d - d_s), "acceleration": (-a * (d - d_s) - J @ qd) / PERIOD - drift,
                  "barrier": -drift - (a + GAIN) * (J @ qd) - a * GAIN * (d - d_s)}
        near = np.flatnonzero(d < d_i)
        for level, damper in dampers.items():
            A, b = damper.update(q, qd)
            assert damper.near == near.tolist() and A.shape == (len(near), len(q)) and b.shape == (len(near),)
            assert np.array_equal(A, damper.A[near]) and np.array_equal(b, damper.b[near])
            assert (damper.b[d >= d_i] == -np.inf).all()
            # Another start, accurate to rounding, which 1 / dt and the curvatures up to 1 / r magnify.
            np.testing.assert_allclose(damper.A[shallow], J[shallow], rtol=0, atol=1e-9)
            both = shallow & (d < d_i)
            np.testing.assert_allclose(damper.b[both], bounds[level][both], rtol=1e-9, atol=1e-6)
            np.testing.assert_allclose(damper.d[shallow], d[shallow], rtol=0, atol=1e-13)
            seen += both.sum()
    assert seen > 100


def test_a_pair_that_enters_too_fast_gets_a_larger_xi(robot):
    a, raised = XI / (D_I - D_S), 0
    for q, qd in postures(robot, 2, 80):
        damper = damper_of(robot, headroom=0.05)
        damper.update(q, qd)
        for row in damper.near:
            room, v = damper.d[row] - D_S, -damper.A[row] @ qd
            excess = v - a * room
            expected = XI
            if room > 0 and excess > 0:  # docs/control.md: "A row enters", with gains of at most 1 / dt
                expected = min(1 / PERIOD, (v + min(0.05, excess)) / room) * (D_I - D_S)
                raised += 1
            assert damper.damping(row) == pytest.approx(expected, rel=1e-12)
            assert damper.b[row] == pytest.approx(-expected / (D_I - D_S) * room, rel=1e-12)
        assert damper.barrier_gain(0) == GAIN
    assert raised > 20


def test_what_makes_no_rows_is_refused_by_its_name_in_python(robot):
    damper, q = damper_of(robot), robot.neutral
    for ask in (lambda: damper.A, lambda: damper.b, lambda: damper.d, lambda: damper.near, lambda: damper.answer(0)):
        with pytest.raises(fcl_stpbv.Error, match="before the first update"):
            ask()
    for bad in (math.nan, math.inf, -math.inf):
        broken = q.copy()
        broken[3] = bad
        with pytest.raises(fcl_stpbv.Error, match="^q: .*not finite"):
            damper.update(broken, q)
        with pytest.raises(fcl_stpbv.Error, match="^qd: .*not finite"):
            damper.update(q, broken)
    with pytest.raises(fcl_stpbv.Error, match="^qd: .*1e100"):
        damper.update(q, 1e200 + 0 * q)
    for wrong in (q[:-1], np.append(q, 0.0), []):
        with pytest.raises(fcl_stpbv.Error, match=f"^q: got {len(wrong)} numbers, expected {len(q)}$"):
            damper.update(wrong, q)
        with pytest.raises(fcl_stpbv.Error, match=f"^qd: got {len(wrong)} numbers, expected {len(q)}$"):
            damper.update(q, wrong)
    with pytest.raises(TypeError):
        damper.update(q.astype(int), q)
    options: list[tuple[dict, str]] = [
        ({"level": "torque"}, 'level: got "torque", expected "velocity", "acceleration" or "barrier"'), ({"influence": D_S}, "influence"),
        ({"damping": math.nan}, "damping"), ({"damping": 0.0}, "damping"), ({"period": 0.0}, "period"), ({"headroom": math.nan}, "headroom"),
        ({"barrier_gain": -1.0}, "VelocityDamper: barrier_gain: "), ({"rows": {len(robot.rows): (0.05, 0.01, 0.5)}}, "no row"),
        ({"rows": {2: (0.05, 0.06, 0.5)}}, "influence of row 2")]
    for more, told in options:
        with pytest.raises(fcl_stpbv.Error, match=told):
            damper_of(robot, **more)
    with pytest.raises(fcl_stpbv.Error, match="give the Robot a larger influence, exact_up_to or hand_over"):
        damper_of(fcl_stpbv.Robot(*FILES, influence=D_I))
    damper.update(q, q)
    for row in (-1, len(robot.rows)):
        of_row: list[Callable] = [damper.answer, damper.damping, damper.barrier_gain]
        for ask in of_row:
            with pytest.raises(fcl_stpbv.Error, match=f"no row {row}"):
                ask(row)


def test_a_damper_depends_on_nothing_else_that_its_robot_is_asked():
    robot = fcl_stpbv.Robot(*FILES)
    (q, qd), (other, _) = postures(robot, 3, 2)
    first, second = damper_of(robot), damper_of(robot)
    robot.distances(other)
    rows = first.update(q, qd)
    robot.distances(other)
    del robot
    again = second.update(q, qd)
    assert all(np.array_equal(one, two) for one, two in zip(rows, again)) and len(rows[1]) > 0
    third = first.answer(first.near[0])
    second.update(other, qd)
    assert np.array_equal(third.points, first.answer(first.near[0]).points)


def test_other_threads_go_on_during_an_update(robot):
    damper, ticks, stop = damper_of(robot), [0], threading.Event()

    def count():
        while not stop.is_set():
            ticks[0] += 1
            time.sleep(0)

    other, usual = threading.Thread(target=count), sys.getswitchinterval()
    other.start()
    try:
        sys.setswitchinterval(1000)  # so that this thread loses the lock only by releasing it
        deadline = time.monotonic() + 30
        met = False
        while not met and time.monotonic() < deadline:
            for q, qd in postures(robot, 4, 5):
                before = ticks[0]
                damper.update(q, qd)
                met = met or ticks[0] > before
    finally:
        sys.setswitchinterval(usual)
        stop.set()
        other.join()
    assert met


def test_answers_have_the_points_and_normals_of_each_row():
    robot = fcl_stpbv.Robot(*FILES, influence=0.2)
    q, qd = robot.configuration("half_sitting"), np.linspace(-0.3, 0.3, len(robot.names))
    d, answers = robot.distances(q), robot.answers(q)
    assert len(answers) == len(d)
    step = 1e-6
    moving, ahead, behind = robot.answers(q, qd), robot.answers(q + step * qd, None), robot.answers(q - step * qd)
    near = 0
    for row, answer in enumerate(answers):
        if answer.status == fcl_stpbv.Status.invalid:
            assert d[row] == pytest.approx(0.15, abs=1e-12)  # so far that its spheres were enough: 3/4 of influence
            assert answer.distance == answer.lower == -math.inf and answer.upper == math.inf
            assert not answer.normal.any() and not answer.points.any()
            continue
        assert answer.status == fcl_stpbv.Status.exact and answer.continuous and answer.points.shape == (2, 3)
        assert answer.lower <= answer.distance <= answer.upper
        np.testing.assert_allclose(answer.points[1] - answer.points[0], answer.distance * answer.normal, atol=1e-13)
        assert not answer.normal_velocity.any() and not answer.point_velocities.any()
        if answer.distance < robot.exact_up_to[row]:
            near += 1
            assert d[row] == pytest.approx(answer.distance, abs=1e-14)
            # Central differences: rounding of 1e-15 / 1e-6, magnified by 1 / r.
            np.testing.assert_allclose(moving[row].normal_velocity, (ahead[row].normal - behind[row].normal) / (2 * step), atol=1e-5)
            np.testing.assert_allclose(moving[row].point_velocities, (ahead[row].points - behind[row].points) / (2 * step), atol=1e-5)
    assert near > 3
    with pytest.raises(fcl_stpbv.Error, match="^qd: got 1 "):
        robot.answers(q, q[:1])
    with pytest.raises(fcl_stpbv.Error, match="^q: "):
        robot.answers(math.nan * q)


def test_no_gradient_turns_faster_than_its_bound(robot):
    step, tight = 1e-6, 0.0
    for q, qd in postures(robot, 5, 5):
        bounds = robot.gradient_rate_bounds(q, qd)
        d = robot.distances(q)
        rate = np.linalg.norm(robot.evaluate(q + step * qd)[1] - robot.evaluate(q - step * qd)[1], axis=1) / (2 * step)
        apart = d > 0.01
        assert bounds.shape == d.shape and np.isfinite(bounds[apart]).all()
        assert (rate[apart] <= bounds[apart] + 1e-6).all()
        tight = max(tight, (rate[apart] / bounds[apart]).max())
    assert tight > 0.1


def test_a_row_is_the_distance_up_to_exact_up_to_and_bends_over_beyond(robot):
    q = robot.configuration("half_sitting")
    d = robot.distances(q)
    assert (robot.exact_up_to == np.inf).all()
    for given, exact in ((None, 0.1), (0.19, 0.19), (0.0, 0.0)):
        bent = fcl_stpbv.Robot(*FILES, influence=0.2, exact_up_to=given)
        assert (bent.exact_up_to == exact).all()
        values = bent.distances(q)
        np.testing.assert_allclose(values[d <= exact], d[d <= exact], rtol=0, atol=1e-13)
        np.testing.assert_allclose(values[d >= 0.2], (0.2 + exact) / 2, rtol=0, atol=1e-13)
        if exact > 0:
            damper_of(bent, influence=exact)
    for wrong in (0.2, 0.3, -1.0, math.nan, math.inf):
        with pytest.raises(fcl_stpbv.Error, match="^exact_up_to: got .* below influence"):
            fcl_stpbv.Robot(*FILES, influence=0.2, exact_up_to=wrong)
    for hand_over in (math.inf, 0.1):
        with pytest.raises(fcl_stpbv.Error, match="^exact_up_to: got 0.05, which needs an influence"):
            fcl_stpbv.Robot(*FILES, exact_up_to=0.05, hand_over=hand_over)


def test_the_bound_on_the_acceleration_is_the_formula_of_the_page():
    bound = fcl_stpbv.collision_acceleration_bound
    assert bound(smallest_h=4, smallest_g=25, gradient=3, bound=2, multiplier=4, solution=1) == 3 * 4 / 2 + (2 + 3 * 1) / 5
    assert bound(smallest_h=1, smallest_g=0) == 0
    assert bound(smallest_h=1, smallest_g=0, bound=1) == math.inf
    for name in ("gradient", "bound", "multiplier", "solution"):
        for wrong in (-1.0, math.nan):
            with pytest.raises(fcl_stpbv.Error, match=f"^{name}: got {wrong}, expected 0 or more"):
                bound(smallest_h=1, smallest_g=1, **{name: wrong})


def test_answers_bound_the_distance_of_the_meshes_when_asked(robot):
    measured = fcl_stpbv.Robot(*FILES, measure_meshes=True)
    q = robot.configuration("half_sitting")
    assert all(math.isnan(answer.mesh_distance_most) for answer in robot.answers(q))
    more = np.array([answer.mesh_distance_most - answer.upper for answer in measured.answers(q)])
    apart = np.array([answer.distance > 0 for answer in measured.answers(q)])
    assert apart.sum() > 100 and (more[apart] > 0.02).all() and np.isnan(more[~apart]).all()  # r of both bodies at least
    damper = damper_of(measured)
    damper.update(q, 0 * q)
    row = int(np.argmax(apart))
    assert damper.answer(row).mesh_distance_most == pytest.approx(damper.answer(row).upper + more[row], abs=1e-12)
