"""Motions of a robot in Python: proofs and first contacts against samples and closed forms."""
import math
import os
import pathlib
import pickle
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np
import pytest

import fcl_stpbv
from test_module import hook, seconds_until_ctrl_c_ends  # noqa: F401, a fixture

DATA = pathlib.Path(os.environ.get("FCL_STPBV_DATA", pathlib.Path(__file__).parents[2] / "data"))
FREE, CONTACT, UNDECIDED = fcl_stpbv.MotionVerdict.free, fcl_stpbv.MotionVerdict.contact, fcl_stpbv.MotionVerdict.undecided
ROUNDING = 1e-12  # of distances of bodies within some metres


def humanoid(**options):
    return fcl_stpbv.Robot(DATA / "hrp2_style/hrp2_style.urdf", DATA / "hrp2_style/hrp2_style.srdf", **options)


def near(robot, q, random, share):
    """q with each joint moved by at most a share of its range."""
    span = np.minimum(robot.upper - robot.lower, 2 * math.pi)
    return q + share * span * random.uniform(-1, 1, size=q.size)


def between(q0, q1, times):
    return q0 + np.asarray(times)[:, None] * (q1 - q0)


@pytest.mark.parametrize("margin", [0.0, 0.01, -0.003])
def test_motions_are_judged_as_dense_samples_see_them(margin):
    robot, random, tolerance, count = humanoid(), np.random.default_rng(7), 1e-5, 201
    standing = robot.configuration("half_sitting")
    seen = {FREE: 0, CONTACT: 0}
    points = [standing]
    for k in range(40):
        points.append(near(robot, standing if k % 2 else robot.neutral, random, (0.02, 0.1, 0.4)[k % 3]))
        q0, q1 = points[-2:]
        found = robot.first_contact(q0, q1, margin=margin, tolerance=tolerance)
        assert robot.is_motion_free(q0, q1, margin=margin) == (found.verdict == FREE)
        times = np.linspace(0, 1, count)
        least = robot.distances_many(between(q0, q1, times)).min(axis=1)
        seen[found.verdict] += 1
        if found.verdict == FREE:
            assert (found.free_until, found.contact_at, found.row) == (1, None, None)
            assert (least > margin - ROUNDING).all()
            continue
        assert found.contact_at is not None and found.row is not None
        assert 0 <= found.free_until <= found.contact_at <= min(1, found.free_until + tolerance)
        assert (least[times < found.free_until] > margin - ROUNDING).all()
        assert robot.distances(between(q0, q1, [found.contact_at])[0])[found.row] <= margin + ROUNDING
        shortly_before = np.linspace(max(0, found.free_until - 1e-3), found.free_until, 20, endpoint=False)
        assert (robot.distances_many(between(q0, q1, shortly_before)) > margin - ROUNDING).all() or found.free_until == 0
        anywhere = robot.first_contact(q0, q1, margin=margin, tolerance=1)
        assert anywhere.verdict == CONTACT and anywhere.free_until <= found.contact_at
    assert min(seen.values()) >= 5
    free = [robot.is_motion_free(*pair, margin=margin) for pair in zip(points, points[1:])]
    for first in range(len(free)):
        rest = free[first:]
        assert robot.first_unproven_motion(points[first:], margin=margin) == (rest.index(False) if False in rest else None)


def spheres(folder, obstacle=False):
    """A ball of 0.1 m that slides along x, 0.2 m beside one of 0.05 m at x = 1. Two more balls turn, which has no effect."""
    ball = "<collision><origin xyz='{}'/><geometry><sphere radius='{}'/></geometry></collision>"
    limit = "<limit lower='-9' upper='9' effort='1' velocity='1'/>"
    (folder / "slide.urdf").write_text(
        "<robot name='slide'><link name='base'>" + ("" if obstacle else ball.format("1 0.2 0", 0.05)) + "</link><link name='ball'>" +
        ball.format("0 0 0", 0.1) + "</link><joint name='x' type='prismatic'><parent link='base'/><child link='ball'/>"
        "<axis xyz='1 0 0'/>" + limit + "</joint></robot>")
    (folder / "slide.srdf").write_text("<robot name='slide'/>")
    (folder / "other.urdf").write_text("<robot name='other'><link name='other'>" + ball.format("1 0.2 0", 0.05) + "</link></robot>")
    files = (folder / "slide.urdf", folder / "slide.srdf", *([folder / "other.urdf"] if obstacle else []))
    return fcl_stpbv.Robot(*files, r=0.001)


@pytest.mark.parametrize("obstacle", [False, True])
@pytest.mark.parametrize("tolerance", [1e-2, 1e-4, 1e-9])
def test_a_sliding_ball_meets_another_when_the_closed_form_says(tmp_path, obstacle, tolerance):
    robot = spheres(tmp_path, obstacle)
    assert robot.distances([0.0])[0] == pytest.approx(math.hypot(1, 0.2) - 0.15, abs=1e-9)  # balls, to the accuracy of their covers
    q0, q1 = np.array([-0.5]), np.array([2.5])
    for margin in (0.0, 0.04, -0.03):
        when = (1.5 - math.sqrt((0.15 + margin) ** 2 - 0.2**2)) / 3 if 0.15 + margin > 0.2 else None
        assert when is None  # 5 cm stay between them
        assert robot.is_motion_free(q0, q1, margin=margin)
    for margin in (0.0501, 0.06, 0.3):
        when = (1.5 - math.sqrt((0.15 + margin) ** 2 - 0.2**2)) / 3
        found = robot.first_contact(q0, q1, margin=margin, tolerance=tolerance)
        assert found.verdict == CONTACT and found.row == 0 and found.contact_at is not None
        assert found.free_until - 1e-8 <= when <= found.contact_at + 1e-8 and found.contact_at - found.free_until <= tolerance
        assert not robot.is_motion_free(q0, q1, margin=margin)
        back = robot.first_contact(q1, q0, margin=margin, tolerance=tolerance)
        assert back.free_until - 1e-8 <= when <= (back.contact_at or 0) + 1e-8  # 1 is the middle, so both directions are alike
        assert found.free_until > 0 and robot.is_motion_free(q0, q0 + (found.free_until - 1e-6) * (q1 - q0), margin=margin)
    d, time, proven = robot.closest_approach(q0, q1, precision=tolerance)
    assert proven and 0.05 - 1e-9 <= d[0] <= 0.05 + tolerance + 1e-9
    assert d[0] == pytest.approx(math.hypot(1.5 - 3 * time[0], 0.2) - 0.15, abs=1e-9)


def test_a_motion_that_grazes_the_margin_is_not_free(tmp_path):
    robot = spheres(tmp_path)
    margin = robot.distances([1.0])[0]
    found = robot.first_contact([0.0], [2.0], margin=margin)
    assert found.verdict in (CONTACT, UNDECIDED) and found.row == 0
    assert found.free_until == pytest.approx(0.5, abs=1e-4) and (found.contact_at is None) == (found.verdict == UNDECIDED)
    assert not robot.is_motion_free([0.0], [2.0], margin=margin)
    assert robot.first_unproven_motion([[-1.0], [0.0], [2.0]], margin=margin) == 1


def test_a_motion_that_stands_still_is_its_posture():
    robot, random = humanoid(), np.random.default_rng(3)
    for q in random.uniform(robot.lower, robot.upper, size=(20, len(robot.names))) * 0.5:
        assert robot.is_motion_free(q, q) != robot.collides(q)
        found = robot.first_contact(q, q)
        assert found.verdict == FREE or (found.verdict, found.free_until) == (CONTACT, 0)


def test_the_closest_approach_of_each_row_is_what_samples_find():
    robot, random, precision = humanoid(), np.random.default_rng(5), 1e-5
    standing = robot.configuration("half_sitting")
    proofs = 0
    for k in range(15):
        q0, q1 = near(robot, standing, random, 0.05), near(robot, standing, random, 0.05)
        d, time, proven = robot.closest_approach(q0, q1, precision=precision)
        assert d.shape == time.shape == (len(robot.rows),) and ((0 <= time) & (time <= 1)).all()
        proofs += proven
        sampled = robot.distances_many(between(q0, q1, np.linspace(0, 1, 301))).min(axis=0)
        assert not proven or (d - precision <= sampled + ROUNDING).all()
        for row in d.argsort()[:10]:
            assert robot.distances(between(q0, q1, time[[row]])[0])[row] == pytest.approx(d[row], abs=1e-9)
        assert not proven or robot.is_motion_free(q0, q1, margin=d.min() - 2 * precision)
        assert not robot.is_motion_free(q0, q1, margin=d.min() + 1e-9)
    assert proofs >= 10


def test_rows_of_links_in_parts_are_those_of_the_robot(hook):  # noqa: F811
    files = hook / "hook.urdf", hook / "hook.srdf", hook / "post.urdf"
    needs = [("l", "block", np.zeros(1), 0.04)]
    approaches: dict[str, float] = {}
    for hand_over in (math.inf, 0.2):
        hulls = fcl_stpbv.Robot(*files, r=0.001, hand_over=hand_over)
        fine, unmet = hulls.model_for(needs, budgets=[0.05])
        assert unmet == []
        assert not hulls.is_motion_free([-0.01], [0.01]) and fine.is_motion_free([-0.01], [0.01])
        for q1, name in ((1.0, "post"), (-1.0, "l")):  # into the post, and into the notch's arm
            found = fine.first_contact([0.0], [q1], tolerance=1e-6)
            assert found.verdict == CONTACT and found.row is not None and found.contact_at is not None
            assert name in fine.rows[found.row].replace("block", "")
            assert fine.distances([q1 * found.contact_at])[found.row] <= ROUNDING
            assert fine.distances([q1 * (found.free_until - 1e-4)]).min() > 0
        d, time, proven = fine.closest_approach([0.0], [0.2], precision=1e-6)
        assert proven and np.isinf(d).sum() == (hand_over < 1)  # the row of the hulls, which hands over
        least = fine.distances_many(np.linspace(0, 0.2, 2001)[:, None]).min()
        assert d.min() == pytest.approx(least, abs=2e-4)
        finite = {name: value for name, value in zip(fine.rows, d) if value < math.inf}
        approaches = approaches or finite
        assert finite == pytest.approx(approaches, abs=1e-5)


def test_what_is_wrong_is_told_by_name(tmp_path):
    robot = humanoid()
    q = robot.configuration("half_sitting")
    bad = q.copy()
    bad[3] = math.nan
    asks: list[Any] = [robot.is_motion_free, robot.first_contact, robot.closest_approach]
    for ask in asks:
        for wrong, told in ((q[:-1], f"got {q.size - 1} numbers, expected {q.size}"), (bad, "not finite"), (q + math.inf, "not finite")):
            with pytest.raises(fcl_stpbv.Error, match=f"^q0: .*{told}"):
                ask(wrong, q)
            with pytest.raises(fcl_stpbv.Error, match=f"^q1: .*{told}"):
                ask(q, wrong)
        for wrong in (q.astype(int), q.astype(complex), np.ma.masked_array(q), None, "q"):
            with pytest.raises(TypeError):
                ask(q, wrong)
        with pytest.raises(TypeError):
            ask(q, q, 0.01)  # by name only
    for ask in (lambda **o: robot.is_motion_free(q, q, **o), lambda **o: robot.first_contact(q, q, **o),
                lambda **o: robot.first_unproven_motion([q, q], **o)):
        with pytest.raises(fcl_stpbv.Error, match="^margin: is not a number"):
            ask(margin=math.nan)
    for tolerance in (0.0, -1e-3, 1e-13, 1.1, math.nan, math.inf):
        with pytest.raises(fcl_stpbv.Error, match="^tolerance: got .*, expected a number from 1e-12 to 1$"):
            robot.first_contact(q, q, tolerance=tolerance)
    for precision in (0.0, -1.0, math.nan):
        with pytest.raises(fcl_stpbv.Error, match="^precision: got .*, expected a length above 0"):
            robot.closest_approach(q, q, precision=precision)
    with pytest.raises(fcl_stpbv.Error, match="^q: .*rows of 3"):
        robot.first_unproven_motion([q[:3], q[:3]])
    with pytest.raises(fcl_stpbv.Error, match="^q: .*not finite"):
        robot.first_unproven_motion([q, q, bad])
    empty: list[Any] = [[], np.zeros((0, q.size)), [q]]
    for few in empty:  # a path without motions is not a free one
        with pytest.raises(fcl_stpbv.Error, match="^q: has [01] way points, a motion needs two"):
            robot.first_unproven_motion(few)
    assert robot.is_motion_free(q, q) and robot.first_unproven_motion([q, q]) is None  # and it answers on


def test_a_robot_without_pairs_says_nothing_about_motions(tmp_path):
    (tmp_path / "one.urdf").write_text("<robot name='one'><link name='one'><collision><geometry><sphere radius='1'/></geometry></collision></link></robot>")
    robot = fcl_stpbv.Robot(tmp_path / "one.urdf", base="floating")
    q = robot.neutral
    for ask in (lambda: robot.collides(q), lambda: robot.is_motion_free(q, q), lambda: robot.first_contact(q, q),
                lambda: robot.closest_approach(q, q), lambda: robot.first_unproven_motion([q, q])):
        with pytest.raises(fcl_stpbv.Error, match="^no pair of bodies is checked"):
            ask()


def test_margins_of_any_size():
    robot = humanoid()
    q0 = robot.configuration("half_sitting")
    q1 = near(robot, q0, np.random.default_rng(1), 0.01)
    for margin in (-math.inf, -1e308, -10.0):
        assert robot.is_motion_free(q0, q1, margin=margin) and not robot.collides(q0, margin=margin)
    for margin in (10.0, 1e308, math.inf):
        assert not robot.is_motion_free(q0, q1, margin=margin) and robot.collides(q0, margin=margin)
        found = robot.first_contact(q0, q1, margin=margin)
        assert (found.verdict, found.free_until) == (CONTACT, 0)


@pytest.mark.parametrize("far", [1e20, 1e160, 1e308])
def test_links_too_far_away_are_not_free(tmp_path, far):
    spheres(tmp_path)
    robot = fcl_stpbv.Robot(tmp_path / "slide.urdf", tmp_path / "slide.srdf", r=0.001)
    for q0, q1 in (([0.0], [far]), ([-far], [far]), ([far], [far])):
        found = robot.first_contact(q0, q1, margin=0.06)
        assert math.isfinite(found.free_until) and 0 <= found.free_until <= 1
        assert robot.is_motion_free(q0, q1, margin=0.06) == (found.verdict == FREE)
        d, time, proven = robot.closest_approach(q0, q1)
        assert not np.isnan(d).any() and 0 <= time[0] <= 1
        if q0 == [0.0] and far < 1e100:
            assert found.verdict != FREE  # it passes the other ball at the very beginning
        if far > 1e100:
            assert found.verdict != FREE and not proven
        if q0 == q1:  # what cannot be measured is not far, as in distances()
            assert d[0] == pytest.approx(robot.distances(q0)[0], rel=1e-15)


def test_arrays_of_any_layout_are_taken_and_left_alone():
    robot, random = humanoid(), np.random.default_rng(2)
    standing = robot.configuration("half_sitting")
    q1 = near(robot, standing, random, 0.1).astype(np.float32)
    exact, wide = q1.astype(float), np.zeros((q1.size, 3))
    wide[:, 1] = exact
    expected = robot.first_contact(standing, exact, margin=0.01)
    for given in (q1, wide[:, 1], exact[::-1].copy()[::-1], exact.tolist(), tuple(exact.tolist()), np.asfortranarray(exact)):
        found = robot.first_contact(standing, given, margin=0.01)
        assert (found.verdict, found.row) == (expected.verdict, expected.row)
        assert found.free_until == pytest.approx(expected.free_until, abs=1e-4)
    path = np.linspace(standing, exact, 9)
    first = robot.first_unproven_motion(path, margin=0.01)
    strided = np.zeros((18, 2 * q1.size))
    strided[::2, 1::2] = path
    for rows in (np.asfortranarray(path), strided[::2, 1::2], path.tolist(), list(path)):
        assert robot.first_unproven_motion(rows, margin=0.01) == first
    frozen = [standing.copy(), exact.copy(), path.copy()]
    for array in frozen:
        array.setflags(write=False)
    robot.is_motion_free(frozen[0], frozen[1]), robot.first_contact(frozen[0], frozen[1])
    robot.closest_approach(frozen[0], frozen[1]), robot.first_unproven_motion(frozen[2])
    for array, before in zip(frozen, (standing, exact, path)):
        assert np.array_equal(array, before)


def test_motions_leave_other_answers_alone():
    robot, other = humanoid(), humanoid()
    q0 = robot.configuration("half_sitting")
    q1 = near(robot, q0, np.random.default_rng(9), 0.3)
    before = robot.distances(q0)
    assert not robot.collides(q0, margin=0.02) and robot.first_contact(q0, q1, margin=0.5).verdict == CONTACT
    assert not robot.collides(q0) and robot.collides(q0, margin=0.5)  # each call has its own margin
    np.testing.assert_allclose(robot.distances(q0), before, rtol=0, atol=1e-14)
    found, alone = robot.first_contact(q0, q1), other.first_contact(q0, q1)  # the cache changes only the time
    assert (found.verdict, found.row) == (alone.verdict, alone.row) and found.free_until == pytest.approx(alone.free_until, abs=1e-4)


def test_two_threads_get_the_answers_of_one():
    robot, random = humanoid(), np.random.default_rng(11)
    standing = robot.configuration("half_sitting")
    motions = [(near(robot, standing, random, 0.1), near(robot, standing, random, 0.1)) for _ in range(200)]

    def first_contacts(chosen):
        found = [robot.first_contact(*motion, margin=0.005) for motion in chosen]
        return [(one.verdict, one.row) for one in found]

    def free(chosen):
        return [robot.is_motion_free(*motion, margin=0.005) for motion in chosen]

    def paths(chosen):
        return [robot.first_unproven_motion(motion, margin=0.005) for motion in chosen]

    def approaches(chosen):
        return [robot.closest_approach(*motion)[2] for motion in chosen]

    asks = (free, first_contacts, paths, lambda chosen: approaches(chosen[:20]))
    alone = [ask(motions) for ask in asks]
    assert min(alone[0].count(True), alone[0].count(False)) >= 20
    with ThreadPoolExecutor(2) as pool:
        together = [pool.submit(ask, motions) for ask in 2 * asks]
        assert [one.result() for one in together] == 2 * alone


def test_two_threads_may_use_one_damper():
    robot = humanoid()
    standing, other = robot.configuration("half_sitting"), near(robot, robot.configuration("half_sitting"), np.random.default_rng(2), 0.1)
    damper = fcl_stpbv.VelocityDamper(robot, influence=0.05, security=0.01, damping=0.5, headroom=-1.0)
    still = np.zeros(len(standing))
    alone = {q.tobytes(): damper.update(q, still) for q in (standing, other)}
    rows = [A.shape for A, _ in alone.values()]

    def update(q):
        for _ in range(200):
            A, b = damper.update(q, still)
            np.testing.assert_allclose(A, alone[q.tobytes()][0], rtol=0, atol=1e-9)  # where a query starts changes the last bits
            np.testing.assert_allclose(b, alone[q.tobytes()][1], rtol=0, atol=1e-9)
            assert (len(damper.near), len(still)) in rows and len(damper.A) == len(damper.b) == len(robot.rows)
    with ThreadPoolExecutor(2) as pool:
        for one in [pool.submit(update, q) for q in (standing, other)]:
            one.result()


def test_brackets_are_only_read():
    robot = humanoid()
    q = robot.configuration("half_sitting")
    found = robot.first_contact(q, q)
    assert repr(found) == "<MotionBracket: free, free until 1.0>"
    for name in ("verdict", "free_until", "contact_at", "row"):
        with pytest.raises(AttributeError):
            setattr(found, name, None)
    with pytest.raises(TypeError, match="cannot pickle"):
        pickle.dumps(found)
    assert pickle.loads(pickle.dumps(found.verdict)) == FREE
    with pytest.raises(TypeError):
        fcl_stpbv.MotionBracket()


def test_a_path_ends_with_ctrl_c_and_the_robot_answers_on():
    robot = humanoid()
    q = robot.configuration("half_sitting")
    path = np.tile([q, q + 0.01], (100000, 1))
    assert robot.first_unproven_motion(path[:3]) is None
    assert seconds_until_ctrl_c_ends(lambda: robot.first_unproven_motion(path)) < 5
    assert robot.first_unproven_motion(path[:3]) is None
