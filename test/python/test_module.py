"""The Python module: arrays in and out, files, errors, a robot's constraints against differences."""
import copy
import functools
import json
import math
import os
import pathlib
import pickle
import re
import signal
import threading
import time
import warnings
from typing import Any, Callable

import numpy as np
import pytest

import fcl_stpbv

DATA = pathlib.Path(os.environ.get("FCL_STPBV_DATA", pathlib.Path(__file__).parents[2] / "data"))
BOX = np.array([[x, y, z] for x in (-0.1, 0.1) for y in (-0.1, 0.1) for z in (-0.1, 0.1)])


def pose(x=0.0, angle=0.0):
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, -s, 0, x], [s, c, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])


def box():
    return fcl_stpbv.StpBv.build(BOX, r=0.01, R=10.0)


def test_facing_boxes_are_apart_by_the_gap_less_the_over_cover():
    found = fcl_stpbv.distance(box(), pose(), box(), pose(0.5))
    assert found.status == fcl_stpbv.Status.exact
    assert found.distance == pytest.approx(0.3 - 2 * box().over_cover()[0], abs=1e-14)  # a few roundings of 0.5
    assert found.lower <= found.distance <= found.upper
    assert found.points.shape == (2, 3) and found.gradient.shape == (2, 6)
    np.testing.assert_allclose(found.points[1] - found.points[0], found.distance * found.normal, atol=1e-14)


def test_the_over_cover_is_over_the_points_where_they_are_given():
    points = np.vstack([BOX, np.vstack([np.eye(3), -np.eye(3)]) * 0.102])  # 2 mm over the sides, which the volume covers by 10 mm
    volume = fcl_stpbv.StpBv.build(points, r=0.01, R=1.0)
    assert len(volume.vertices) == len(BOX)
    directions = np.vstack([[1, 0.02, 0], np.random.default_rng(1).normal(size=(1000, 3))])  # the first is a normal of the points' hull
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    excess = [volume.support(n) - (points @ n).max() for n in directions]
    largest, mean = volume.over_cover(points)
    assert max(excess) == excess[0] == pytest.approx(largest, abs=1e-15) and mean < largest
    assert volume.over_cover()[0] == pytest.approx(0.99 - math.sqrt(0.99**2 - 0.02) + 0.01, abs=1e-14) and largest < volume.over_cover()[0] - 0.001
    with pytest.raises(fcl_stpbv.Error):
        volume.over_cover(np.zeros((0, 3)))
    for wrong in (points + [0.5, 0, 0], 1e3 * points, 1e150 * points):  # of another body, or in millimetres
        with pytest.raises(fcl_stpbv.Error, match="^points: point [0-9]+ is outside the volume; give those that it was built from$"):
            volume.over_cover(wrong)


def test_the_gradient_is_what_differences_say():
    volume, angle, step = box(), 0.3, 1e-6
    ask = lambda x, a: fcl_stpbv.distance(volume, pose(), volume, pose(x, a))
    found = ask(0.5, angle)
    along_x = (ask(0.5 + step, angle).distance - ask(0.5 - step, angle).distance) / (2 * step)
    about_z = (ask(0.5, angle + step).distance - ask(0.5, angle - step).distance) / (2 * step)
    # Central differences: rounding of 1e-16 / 1e-6, and step^2 times a third derivative of at most 1 / r^2.
    assert found.gradient[1, 0] == pytest.approx(along_x, abs=1e-8)
    assert found.gradient[1, 5] == pytest.approx(about_z, abs=1e-8)


def test_advised_radii_keep_the_clearance_and_say_what_else_they_reach():
    advise = functools.partial(fcl_stpbv.advise_radii, BOX, acceleration=2.0, speed=0.15, turning=0.5, distance=0.01)
    advice = advise(clearance=0.02)
    volume = fcl_stpbv.StpBv.build(BOX, advice.r, advice.R)
    assert advice.meets_both and advice.acceleration <= 2
    assert volume.over_cover()[0] == advice.over_cover <= 0.02 - advice.per_period
    less = advise(clearance=0.5 * advice.least_clearance)
    assert not less.meets_both and less.acceleration > 2 and less.over_cover <= 0.5 * advice.least_clearance
    assert less.least_clearance == advice.least_clearance
    with pytest.raises(fcl_stpbv.Error, match="clearance"):
        fcl_stpbv.advise_radii(BOX, clearance=math.nan)


def test_a_cache_does_not_change_the_answer():
    volume, cache = box(), fcl_stpbv.PairCache()
    for angle in np.linspace(-1, 1, 50):
        cold = fcl_stpbv.distance(volume, pose(), volume, pose(0.4, angle))
        warm = fcl_stpbv.distance(volume, pose(), volume, pose(0.4, angle), cache)
        assert warm.distance == pytest.approx(cold.distance, abs=1e-15)


def test_a_verification_is_false_where_something_is_wrong():
    volume = box()
    fine = volume.verify()
    assert fine and fine.ok and (fine.message, str(fine), fine.containment) == ("ok", "ok", 0)
    assert volume.verify(volume.vertices)
    outside = volume.verify([[9.0, 0, 0]])
    assert not outside and not outside.ok and outside.containment > 8
    assert str(outside) == outside.message and "nearer to the surface" in outside.message
    with pytest.raises(AssertionError):
        assert outside


def test_files_keep_every_bit(tmp_path):
    path = str(tmp_path / "box.stpbv")
    box().save(path)
    again = fcl_stpbv.StpBv.load(path)
    assert (again.r, again.R) == (0.01, 10.0)
    assert np.array_equal(again.vertices, box().vertices) and again.faces == box().faces
    assert again.verify()


def test_what_is_printed_says_what_it_is():
    assert repr(box()) == "<StpBv: 8 vertices, 6 faces, r = 0.01 m, R = 10 m>"
    good, tight = fcl_stpbv.advise_radii(BOX, acceleration=30.0), fcl_stpbv.advise_radii(BOX)
    assert repr(good) == f"<RadiiAdvice: r = {good.r:.6g} m, R = {good.R:.6g} m, meets both demands>"
    assert repr(tight) == (f"<RadiiAdvice: r = {tight.r:.6g} m, R = {tight.R:.6g} m, keeps the clearance, but may add {tight.acceleration:.4g} m/s^2; "
                           f"that asked for needs {tight.least_clearance:.4g} m>")
    folder = DATA / "hrp2_style"
    robot = fcl_stpbv.Robot(folder / "hrp2_style.urdf", folder / "hrp2_style.srdf")
    assert repr(robot) == f"<Robot hrp2_style: {len(robot.names)} coordinates, {len(robot.rows)} rows>"
    assert repr(fcl_stpbv.VelocityDamper(robot)) == f"<VelocityDamper: {len(robot.rows)} rows>"
    search = fcl_stpbv.PairSearch(folder / "hrp2_style.urdf")
    assert repr(search) == f"<PairSearch hrp2_style: {len(search.names)} coordinates, {len(search.pairs)} pairs>"
    assert re.fullmatch("<PostureSearch hrp2_style: [0-9]+ bodies>", repr(fcl_stpbv.PostureSearch(folder / "hrp2_style.urdf", folder / "hrp2_style.srdf")))
    proof = search.unproven(0)
    assert repr(proof) == "<PairProof: 1 box open, 0 looked at>" and repr(fcl_stpbv.PairProof([], [0.0], 7)) == "<PairProof: colliding, 7 looked at>"
    assert repr(robot.answers(robot.neutral)[0]).startswith("<RowAnswer: ")


def test_errors_name_functions_as_python_does():
    for clearance, period in ((-1.0, 1e-3), (0.01, -1.0), (1e-4, 1e-3)):
        with pytest.raises(fcl_stpbv.Error, match="^advise_radii: "):
            fcl_stpbv.advise_radii(BOX, clearance=clearance, period=period)


def test_a_package_path_is_one_folder_or_several(tmp_path):
    package = tmp_path / "some_robot"
    package.mkdir()
    (package / "l.obj").write_text(prism([(0, 0), (0.4, 0), (0.4, 0.1)], 0.1))
    (package / "package.xml").write_text("<package><name>some_robot</name></package>")
    other = tmp_path / "other"
    other.mkdir()
    urdf = other / "l.urdf"
    urdf.write_text("<robot name='l'><link name='l'><collision><geometry><mesh filename='package://some_robot/l.obj'/></geometry></collision></link></robot>")
    loaders: list[Callable] = [fcl_stpbv.Robot, fcl_stpbv.mesh_files, fcl_stpbv.PostureSearch]
    for load in loaders:
        for folder in (str(tmp_path), tmp_path, os.fsencode(tmp_path), [str(tmp_path)], (other, tmp_path)):
            load(urdf, package_path=folder)
        for wrong in (3, [3], None):
            with pytest.raises(TypeError):
                load(urdf, package_path=wrong)
        for missing in (tmp_path / "nowhere", [tmp_path, urdf], ""):
            with pytest.raises(fcl_stpbv.Error, match=r"^package_path: '.*' is no folder; give one that holds packages"):
                load(urdf, package_path=missing)


def test_errors_name_what_would_work(tmp_path):
    with pytest.raises(fcl_stpbv.Error, match="R"):
        fcl_stpbv.StpBv.build(BOX, R=0.1)
    with pytest.raises(fcl_stpbv.Error, match="missing.stpbv"):
        fcl_stpbv.StpBv.load(str(tmp_path / "missing.stpbv"))
    with pytest.raises(TypeError):
        fcl_stpbv.StpBv.build(np.zeros((4, 2)))
    with pytest.raises(fcl_stpbv.Error, match="no points"):
        fcl_stpbv.StpBv.build([])
    with pytest.raises(ValueError, match="first_pose.*last row"):
        fcl_stpbv.distance(box(), np.zeros((4, 4)), box(), pose())


def test_a_pose_that_is_not_finite_is_invalid_and_not_raised():
    assert fcl_stpbv.distance(box(), pose(math.nan), box(), pose()).status == fcl_stpbv.Status.invalid


def test_a_robots_jacobian_is_what_differences_say(tmp_path, monkeypatch):
    folder = DATA / "hrp2_style"
    robot = fcl_stpbv.Robot(str(folder / "hrp2_style.urdf"), str(folder / "hrp2_style.srdf"))
    q = robot.configuration("half_sitting")
    d, jacobian = robot.evaluate(q)
    assert jacobian.shape == (len(robot.rows), len(robot.names)) == (d.size, q.size)
    # A row starts from its last answer, which changes the result by rounding only: some units of 1 m.
    np.testing.assert_allclose(robot.distances(robot.neutral), robot.evaluate(robot.neutral)[0], rtol=0, atol=1e-15)


def test_rates_and_hessians_of_a_robot_agree_with_its_jacobian():
    folder = DATA / "hrp2_style"
    robot = fcl_stpbv.Robot(str(folder / "hrp2_style.urdf"), str(folder / "hrp2_style.srdf"))
    q = robot.configuration("half_sitting")
    qd = np.linspace(-1, 1, len(q))
    d, jacobian, speed, drift = robot.rates(q, qd)
    np.testing.assert_allclose(d, robot.evaluate(q)[0], rtol=0, atol=1e-15)  # another start, so equal to rounding
    np.testing.assert_allclose(speed, jacobian @ qd, rtol=0, atol=1e-13)
    weights = np.linspace(0, 1, len(d))
    h = robot.hessian(q, weights)
    np.testing.assert_array_equal(h, h.T)
    scale = 1 + abs(h).max()
    np.testing.assert_allclose(h @ qd, robot.hessian_vector(q, weights, qd), rtol=0, atol=1e-12 * scale)
    np.testing.assert_allclose(qd @ h @ qd, weights @ drift, rtol=0, atol=1e-11 * scale)
    with pytest.raises(fcl_stpbv.Error, match="qd: got 1"):
        robot.rates(q, q[:1])
    with pytest.raises(fcl_stpbv.Error, match="weights: got 1"):
        robot.hessian(q, d[:1])
    step, direction = 1e-6, np.random.default_rng(1).normal(size=q.size)
    slope = (robot.distances(q + step * direction) - robot.distances(q - step * direction)) / (2 * step)
    # Second derivatives jump on region boundaries: by up to step |direction|^2 (reach^2 / r + reach), with a reach of about
    # 1 m. Most pairs are far apart, and no pair of this posture is on a boundary.
    np.testing.assert_allclose(jacobian @ direction, slope, atol=1e-6)
    with pytest.raises(fcl_stpbv.Error, match="q: got"):
        robot.distances(q[:-1])


@pytest.mark.parametrize("path", [False, True])
def test_a_batch_is_what_its_rows_are_one_by_one(path):
    folder = DATA / "hrp2_style"
    robot = fcl_stpbv.Robot(folder / "hrp2_style.urdf", folder / "hrp2_style.srdf")
    random = np.random.default_rng(4)
    q = random.uniform(robot.lower, robot.upper, size=(70, len(robot.names)))
    if path:
        q = q[0] + 1e-2 * np.cumsum(random.normal(size=q.shape), axis=0)
    d, jacobian = robot.evaluate_many(q, path=path, threads=2)
    assert d.shape == (70, len(robot.rows)) and jacobian.shape == (70, len(robot.rows), len(robot.names))
    np.testing.assert_array_equal(d, robot.distances_many(q, path=path))  # the same for any number of threads, bit by bit
    hit = robot.collides_many(q, margin=0.01, path=path, threads=2)
    assert hit.dtype == bool and hit.shape == (70,)
    for k in range(70):
        alone, alone_jacobian = robot.evaluate(q[k])
        shallow = alone > -0.02  # both margins; deeper answers may depend on where the search starts
        np.testing.assert_allclose(d[k][shallow], alone[shallow], rtol=0, atol=1e-13)
        np.testing.assert_allclose(jacobian[k][shallow], alone_jacobian[shallow], rtol=0, atol=1e-9)
        assert hit[k] == (alone.min() <= 0.01) == robot.collides(q[k], margin=0.01)
        pair = robot.first_hit(q[k], margin=0.01)
        assert (pair is not None) == hit[k] and (pair is None or alone[pair] <= 0.01)
    assert robot.min_distance(robot.configuration("half_sitting")) == pytest.approx(
        robot.distances(robot.configuration("half_sitting")).min(), abs=1e-14)
    for d, jacobian in (robot.evaluate_many([], path=path, threads=2), robot.evaluate_many(np.zeros((0, len(robot.names))), path=path)):
        assert d.shape == (0, len(robot.rows)) and jacobian.shape == (0, len(robot.rows), len(robot.names))
    assert robot.distances_many([]).shape == (0, len(robot.rows)) and robot.collides_many([]).shape == (0,)
    with pytest.raises(fcl_stpbv.Error, match="rows of 3"):
        robot.collides_many(q[:, :3])
    with pytest.raises(fcl_stpbv.Error, match="threads"):
        robot.collides_many(q, threads=0)
    with pytest.raises(fcl_stpbv.Error, match="^margin: is not a number"):
        robot.collides(q[0], margin=float("nan"))


def test_paths_are_text_bytes_or_path_objects(tmp_path):
    path = tmp_path / "box.stpbv"
    box().save(path)
    for given in (path, str(path), os.fsencode(path)):
        assert fcl_stpbv.StpBv.load(given).verify()
    folder = DATA / "hrp2_style"
    assert len(fcl_stpbv.load_points(folder / "meshes" / "HEAD_LINK1.dae")) > 4
    robot = fcl_stpbv.Robot(folder / "hrp2_style.urdf", folder / "hrp2_style.srdf", package_path=[folder, str(folder)])
    assert robot.rows
    assert fcl_stpbv.mesh_files(folder / "hrp2_style.urdf", [folder]) == fcl_stpbv.mesh_files(str(folder / "hrp2_style.urdf"))
    loaders: list[Callable] = [fcl_stpbv.Robot, fcl_stpbv.PairSearch, fcl_stpbv.PostureSearch, fcl_stpbv.mesh_files]
    for missing in (folder / "none.urdf", folder):
        for load in loaders:
            with pytest.raises(fcl_stpbv.Error, match=re.escape(str(missing))):
                load(missing)


def test_an_error_names_a_file_whatever_bytes_its_name_has():
    name = os.fsdecode(b"no\xff.file")  # not UTF-8
    loaders: list[Callable] = [fcl_stpbv.Robot, fcl_stpbv.PairSearch, fcl_stpbv.PostureSearch, fcl_stpbv.mesh_files, fcl_stpbv.load_points,
                               fcl_stpbv.StpBv.load]
    for load in loaders:
        with pytest.raises(fcl_stpbv.Error, match=f"^{name}: .*no such file"):
            load(name)


@pytest.mark.parametrize("empty", ["", b""])
def test_a_file_with_an_empty_name_is_not_left_out(empty):
    urdf = DATA / "hrp2_style/hrp2_style.urdf"
    search = fcl_stpbv.PairSearch(urdf)
    for name, load in (("srdf", lambda: fcl_stpbv.Robot(urdf, empty)), ("obstacles", lambda: fcl_stpbv.Robot(urdf, None, empty)),
                       ("obstacles", lambda: fcl_stpbv.PairSearch(urdf, empty)), ("srdf", lambda: search.srdf([], empty)),
                       ("srdf", lambda: fcl_stpbv.PostureSearch(urdf, empty)), ("obstacles", lambda: fcl_stpbv.PostureSearch(urdf, None, empty))):
        with pytest.raises(fcl_stpbv.Error, match=f"^{name}: .*empty.*None"):
            load()
    readers: list[Callable] = [fcl_stpbv.load_points, fcl_stpbv.StpBv.load, fcl_stpbv.Robot, fcl_stpbv.mesh_files]
    for read in readers:
        with pytest.raises(fcl_stpbv.Error, match="^the name of a file to read is empty"):
            read(empty)


def test_an_object_whose_constructor_has_not_run_is_no_argument():
    kinds: list[Any] = [fcl_stpbv.StpBv, fcl_stpbv.PairCache, fcl_stpbv.Distance, fcl_stpbv.RadiiAdvice, fcl_stpbv.Robot, fcl_stpbv.PairProof,
                        fcl_stpbv.PairSearch, fcl_stpbv.PostureSearch, fcl_stpbv.MotionBracket, fcl_stpbv.RowAnswer, fcl_stpbv.VelocityDamper,
                        fcl_stpbv.Verification]
    for kind in kinds:
        unmade = kind.__new__(kind)
        for name, member in vars(kind).items():
            if isinstance(member, property):
                of_none: Any = member.fget
                for ask in (lambda: getattr(unmade, name), lambda: of_none(None)):
                    with pytest.raises(TypeError):
                        ask()
    robot, proof, volume = (kind.__new__(kind) for kind in (kinds[4], kinds[5], kinds[0]))
    for ask in (lambda: robot.distances([0.0]), lambda: robot.collides_many([]), lambda: fcl_stpbv.PairProof([]).merge(proof), volume.verify,
                lambda: fcl_stpbv.distance(box(), pose(), volume, pose()), lambda: pickle.dumps(volume), lambda: repr(volume),
                lambda: fcl_stpbv.distance(box(), pose(), box(), pose(), fcl_stpbv.PairCache.__new__(fcl_stpbv.PairCache))):
        with pytest.raises(TypeError):
            ask()


def seconds_until_ctrl_c_ends(ask, pressed=0.2):
    timer = threading.Timer(pressed, signal.raise_signal, [signal.SIGINT])
    timer.start()
    start = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        ask()
    return time.monotonic() - start


@pytest.mark.parametrize("ask", ["collides_many", "distances_many", "evaluate_many"])
def test_a_batch_ends_with_ctrl_c_and_the_robot_answers_on(ask):
    robot = fcl_stpbv.Robot(DATA / "hrp2_style/hrp2_style.urdf", DATA / "hrp2_style/hrp2_style.srdf")
    q = np.random.default_rng(1).uniform(robot.lower, robot.upper, size=(2000, len(robot.names)))
    before = robot.distances_many(q[:3])

    def ended_sooner():
        start = time.monotonic()
        getattr(robot, ask)(q)
        once = time.monotonic() - start
        times = int(5 / once) + 2  # at least 5 s
        many = np.broadcast_to(q, (times, *q.shape)).reshape(-1, q.shape[1])
        return seconds_until_ctrl_c_ends(lambda: getattr(robot, ask)(many)) < 0.5 * times * once
    assert any(ended_sooner() for _ in range(4))  # a busy machine may slow it down, but not each time
    assert np.array_equal(robot.distances_many(q[:3]), before)


def pair_of(search, *links):
    return next(i for i, pair in enumerate(search.pairs) if set(pair) == set(links))


@pytest.mark.parametrize("ask", [
    lambda search, pair: search.prove(pair, search.unproven(pair).open, 10**9),
    lambda search, pair: search.descend(pair, 1, 10**9),
    lambda search, pair: search.sample(1, 0, 10**9)])
def test_pieces_of_proofs_end_with_ctrl_c(ask):
    search = fcl_stpbv.PairSearch(DATA / "hrp2_style/hrp2_style.urdf")
    pair = pair_of(search, "LARM_LINK1", "RARM_LINK6")  # 617,001 boxes, which take at least a minute
    assert seconds_until_ctrl_c_ends(lambda: ask(search, pair)) < 10


def test_a_search_for_a_posture_ends_with_ctrl_c(tmp_path):
    links, ball = 500, "<collision><geometry><sphere radius='0.01'/></geometry></collision>"  # a minute in the solver, 0.1 s per model
    chain = "".join(f"<link name='l{i}'>{ball if i in (0, links - 1) else ''}</link>" for i in range(links)) + "".join(
        f"<joint name='j{i}' type='revolute'><parent link='l{i}'/><child link='l{i + 1}'/><origin xyz='0.15 0 0'/>"
        f"<axis xyz='0 {i % 2} {1 - i % 2}'/><limit lower='-1' upper='1' effort='1' velocity='1'/></joint>" for i in range(links - 1))
    (tmp_path / "chain.urdf").write_text(f"<robot name='chain'>{chain}</robot>")
    (tmp_path / "chain.srdf").write_text("<robot name='chain'/>")
    search = fcl_stpbv.PostureSearch(tmp_path / "chain.urdf", tmp_path / "chain.srdf")
    place = {"link": f"l{links - 1}", "target": {"position": [0.5, 0.2, 0]}, "free": ["rx", "ry", "rz"]}
    task = json.dumps({"base": "fixed", "placements": [place]})
    assert seconds_until_ctrl_c_ends(lambda: search.solve(task, start=3)) < 10
    assert search.solve(json.dumps({"base": "fixed", "placements": []}))["feasible"]


def test_a_proof_in_pieces_is_the_whole_one():
    search = fcl_stpbv.PairSearch(DATA / "hrp2_style/hrp2_style.urdf")
    pair = pair_of(search, "LARM_LINK0", "RARM_LINK5")
    whole = search.prove(pair, search.unproven(pair).open, 1700)
    assert whole.boxes == 1700 and not whole.proven
    first = search.prove(pair, search.unproven(pair).open, 333)
    rest = search.prove(pair, first.open, 1367)
    assert [box[0].tolist() for box in rest.open] == [box[0].tolist() for box in whole.open]


def test_counts_below_their_least_are_refused():
    search = fcl_stpbv.PairSearch(DATA / "hrp2_style/hrp2_style.urdf")
    for name, ask in (("max_boxes", lambda: search.prove(0, search.unproven(0).open, -1)), ("starts", lambda: search.descend(0, 1, -1)),
                      ("count", lambda: search.sample(1, 0, 0))):
        with pytest.raises(fcl_stpbv.Error, match=f"^{name}: got (-1, expected 0|0, expected 1) or more$"):
            ask()


def test_slices_of_a_batch_change_no_bit():
    robot = fcl_stpbv.Robot(DATA / "hrp2_style/hrp2_style.urdf", DATA / "hrp2_style/hrp2_style.srdf")
    path = np.linspace(robot.lower, robot.configuration("half_sitting"), 400)
    whole = robot.evaluate_many(path, path=True)
    for threads in (1, 3):
        d, jacobian = robot.evaluate_many(path, path=True, threads=threads)
        assert np.array_equal(d, whole[0]) and np.array_equal(jacobian, whole[1])
        pieces = [robot.distances_many(path[k:k + 64], path=True) for k in range(0, len(path), 64)]
        assert np.array_equal(robot.distances_many(path, path=True, threads=threads), np.concatenate(pieces))


def test_a_state_of_a_robot_without_an_srdf_says_what_is_missing():
    with pytest.raises(fcl_stpbv.Error, match="^configuration: .*SRDF"):
        fcl_stpbv.Robot(DATA / "hrp2_style/hrp2_style.urdf").configuration("half_sitting")


@pytest.mark.parametrize("protocol", range(pickle.HIGHEST_PROTOCOL + 1))
def test_a_pickled_volume_is_the_same_bit_by_bit(protocol):
    for volume in (box(), fcl_stpbv.StpBv.build(np.random.default_rng(1).normal(size=(300, 3)), r=0.03 / 7, R=100 / 3)):
        again = pickle.loads(pickle.dumps(volume, protocol))
        assert (again.r, again.R, again.faces) == (volume.r, volume.R, volume.faces)
        assert np.array_equal(again.vertices, volume.vertices)
        assert copy.deepcopy(again).verify()
        asked = [fcl_stpbv.distance(v, pose(), v, pose(5, 0.3)) for v in (volume, again)]
        assert asked[0].distance == asked[1].distance and np.array_equal(asked[0].gradient, asked[1].gradient)
    damaged = pickle.dumps(box()).replace(b"vertices 8", b"vertices 9")
    with pytest.raises(fcl_stpbv.Error, match="pickled StpBv"):
        pickle.loads(damaged)


@pytest.mark.parametrize("protocol", range(pickle.HIGHEST_PROTOCOL + 1))
def test_what_cannot_be_pickled_says_so_with_every_protocol(protocol):
    assert pickle.loads(pickle.dumps(fcl_stpbv.Status.local, protocol)) == fcl_stpbv.Status.local
    for thing in (fcl_stpbv.PairCache(), fcl_stpbv.distance(box(), pose(), box(), pose()), fcl_stpbv.PairProof([]),
                  fcl_stpbv.Robot(DATA / "hrp2_style/hrp2_style.urdf")):
        with pytest.raises(TypeError, match=f"cannot pickle '.*{type(thing).__name__}'"):
            pickle.dumps(thing, protocol)


def test_the_base_class_cannot_be_made_nor_can_reduce_make_it():
    base: Any = fcl_stpbv.StpBv.__mro__[1]
    own: Any = type("Own", (base,), {})
    things: list[Any] = [box(), fcl_stpbv.PairCache(), fcl_stpbv.Status.local, fcl_stpbv.distance(box(), pose(), box(), pose())]
    for ask in (base, own, lambda: base(box()), *(thing.__reduce__ for thing in things),
                *(lambda thing=thing, of=of: object.__reduce_ex__(thing, of) for thing in things for of in (0, 1))):
        with pytest.raises(TypeError, match="No constructor"):
            ask()
    assert isinstance(fcl_stpbv.PairCache(), base)


@pytest.mark.parametrize("kind", ["int64", "int32", "bool", "complex128", "str", "object", "longdouble"])
def test_arrays_that_are_not_of_floats_are_refused_by_their_type(kind):
    volume, flat = box(), np.eye(4).astype(kind)
    for ask in (lambda: fcl_stpbv.StpBv.build(BOX.astype(kind)), lambda: volume.support(np.ones(3).astype(kind)),
                lambda: volume.signed_distance(np.ones(3).astype(kind)), lambda: fcl_stpbv.distance(volume, flat, volume, pose(1)),
                lambda: fcl_stpbv.PairProof([(flat[0], np.ones(4))]), lambda: fcl_stpbv.PairProof([], flat[0])):
        with pytest.raises(TypeError, match="expected floats"):
            ask()


def test_many_configurations_where_one_is_expected_are_refused_with_what_takes_many(hook):
    robot = fcl_stpbv.Robot(hook / "hook.urdf", hook / "hook.srdf", r=0.001)
    damper = fcl_stpbv.VelocityDamper(robot)
    many, one = np.zeros((3, 2)), np.zeros(1)
    for ask in (lambda q: robot.distances(q), lambda q: robot.evaluate(q), lambda q: robot.collides(q), lambda q: damper.update(q, one),
                lambda q: damper.update(one, q), lambda q: robot.rates(one, q), lambda q: robot.model_for([("l", "block", q, 0.0)])):
        for given in (many, many.tolist()):
            with pytest.raises(TypeError, match=r"^got an array of shape \(3, 2\), expected a 1-D one; distances_many, .* take many q$"):
                ask(given)
    assert robot.distances_many(np.zeros((3, 1))).shape == (3, len(robot.rows))


def test_masked_arrays_are_refused_as_their_masks_would_be_lost():
    with pytest.raises(TypeError, match="filled"):
        fcl_stpbv.StpBv.build(np.ma.masked_array(BOX, mask=BOX > 1))

    class Own(np.ndarray):
        """Another kind of array."""

    assert np.array_equal(fcl_stpbv.StpBv.build(BOX.view(Own)).vertices, box().vertices)


def test_lists_of_numbers_and_single_precision_are_taken():
    assert box().support([1, 0, 0]) == box().support(np.array([1, 0, 0], dtype=np.float32)) == box().support((1.0, 0.0, 0.0))
    for wrong in (["1", "0", "0"], [1j, 0, 0], [True, False, False], [None, 0, 0], [1, 0], "100", 3):
        with pytest.raises(TypeError):
            box().support(wrong)  # type: ignore[arg-type]
    nothing: Any = None
    for given, told in ((nothing, "NoneType"), (iter([1.0, 0.0, 0.0]), "list_iterator"), ([True, False, False], "list of bool")):
        with pytest.raises(TypeError, match=f"^got {told}, expected an array of floats or a list of numbers$"):
            box().support(given)


def prism(outline, height):
    """A Wavefront mesh of an outline in the xy plane, counter-clockwise, that is a star around its first corner."""
    n = len(outline)
    lines = [f"v {x} {y} {z}" for z in (0, height) for x, y in outline]
    triangles = [(1, i + 1, i) for i in range(2, n)] + [(n + 1, n + i, n + i + 1) for i in range(2, n)]
    for i in range(1, n + 1):
        j = i % n + 1
        triangles += [(i, j, n + j), (i, n + j, n + i)]
    return "\n".join(lines + ["f %d %d %d" % t for t in triangles]) + "\n"


@pytest.fixture
def hook(tmp_path):
    """A block that slides along x into the notch of an L, and a post beside them."""
    (tmp_path / "l.obj").write_text(prism([(0, 0), (0.4, 0), (0.4, 0.1), (0.1, 0.1), (0.1, 0.4), (0, 0.4)], 0.1))
    block = "<collision><geometry><box size='0.1 0.1 0.1'/></geometry></collision>"
    (tmp_path / "hook.urdf").write_text(
        "<robot name='hook'><link name='l'><collision><geometry><mesh filename='l.obj'/></geometry></collision></link>"
        "<link name='block'>" + block + "</link><joint name='slide' type='prismatic'><parent link='l'/><child link='block'/>"
        "<origin xyz='0.2 0.2 0.05'/><axis xyz='1 0 0'/><limit lower='-1' upper='1' effort='1' velocity='1'/></joint></robot>")
    (tmp_path / "hook.srdf").write_text("<robot name='hook'/>")
    (tmp_path / "post.urdf").write_text("<robot name='post'><link name='post'><collision><origin xyz='0.6 0.2 0'/>"
                                        "<geometry><box size='0.1 0.1 0.4'/></geometry></collision></link></robot>")
    return tmp_path


def test_the_meshes_of_whole_bodies_of_parts_and_of_obstacles_are_bounded(hook):
    files = hook / "hook.urdf", hook / "hook.srdf", hook / "post.urdf"
    hulls = fcl_stpbv.Robot(*files, r=0.001, measure_meshes=True)
    q, apart = np.zeros(1), np.ones(1)
    at = {name: answer.mesh_distance_most for name, answer in zip(hulls.rows, hulls.answers(q))}
    assert math.isnan(at["l - block"])  # the block is inside the hull of the L
    assert 0.3 <= at["block - post"] < 0.31  # the true distance, and the covers' excess
    # At q = 1 the block is 0.75 m from the L's lower arm along x and 0.05 m above it. Its hull exceeds the L by about 0.14 m.
    truth = math.hypot(0.75, 0.05)
    answer = hulls.answers(apart)[hulls.rows.index("l - block")]
    assert answer.lower <= truth <= answer.mesh_distance_most < truth + 0.2
    fine, unmet = hulls.model_for([("l", "block", q, 0.04)])
    assert unmet == []
    parts = [(answer.lower, answer.mesh_distance_most) for answer, row in zip(fine.answers(q), fine.rows) if "post" not in row]
    # A part's face where the L was cut is up to 0.05 m from the L's triangles.
    assert len(parts) == 2 and all(lower <= 0.05 <= most < 0.11 for lower, most in parts)


def test_a_robot_is_as_fine_as_its_needs_ask_for(hook):
    files = hook / "hook.urdf", hook / "hook.srdf", hook / "post.urdf"
    hulls = fcl_stpbv.Robot(*files, r=0.001)
    assert len(hulls.rows) == 2  # the L and the post do not move
    assert hulls.vertices == fcl_stpbv.Robot(*files[:2], r=0.001).vertices + 8  # the post's
    q = np.zeros(1)
    assert hulls.distances(q)[0] < 0  # in the notch: inside the hull
    same, unmet = hulls.model_for([])
    assert same.rows == hulls.rows and unmet == []
    # The post's row has the expected distance: 0.55 - 0.25, except for r and the bulge of R.
    assert hulls.distances(q)[1] == pytest.approx(0.3, abs=0.004)
    needs = [("l", "block", q, 0.01), ("post_unknown", "block", q, 0.0)]
    with pytest.raises(fcl_stpbv.Error, match=r'needs\[1\]: .*"post_unknown"$'):
        hulls.model_for(needs)
    with pytest.raises(fcl_stpbv.Error, match=r'needs\[0\]: there is no link or obstacle "pst"; did you mean \'post\'\?'):
        hulls.model_for([("l", "pst", q, 0.0)])
    with pytest.raises(fcl_stpbv.Error, match=r'needs\[0\]: .*"l" and "post".*no pair'):
        hulls.model_for([("l", hulls.rows[1].split()[-1], q, 0.0)])
    (hook / "two.urdf").write_text(files[0].read_text().replace("<link name='block'>",
                                                                "<link name='block'><collision><geometry><sphere radius='0.01'/></geometry></collision>"))
    two = fcl_stpbv.Robot(hook / "two.urdf", files[1])
    assert two.rows[1] == "l - block#2"
    with pytest.raises(fcl_stpbv.Error, match=r'needs\[0\]: .*"block#2"; that is a body of the link "block", and a need names links'):
        two.model_for([("l", "block#2", q, 0.0)])
    (hook / "block.urdf").write_text((hook / "post.urdf").read_text().replace("link name='post'", "link name='block'"))
    with pytest.raises(fcl_stpbv.Error, match=r'needs\[0\]: "block" is a link and an obstacle'):
        fcl_stpbv.Robot(*files[:2], hook / "block.urdf", r=0.001).model_for([("l", "block", q, 0.0)])
    with pytest.raises(fcl_stpbv.Error, match=r"^needs\[0\]: must have a configuration of 1 finite numbers$"):
        hulls.model_for([("l", "block", [0.0, 0.0], 0.0)])
    with pytest.raises(fcl_stpbv.Error, match=r"^needs\[1\]: has a clearance that is not finite$"):
        hulls.model_for([("l", "block", q, 0.0), ("l", "block", q, np.nan)])
    with pytest.raises(TypeError):
        hulls.model_for([("l", "block")])  # type: ignore[list-item]

    # The block is 5 cm from either arm of the L. 4 cm can be kept, 6 cm cannot.
    needs = [("block", "l", q, 0.06), ("l", "block", q, 0.04), ("block", "l", np.ones(1), 0.3)]
    fine, unmet = hulls.model_for(needs, budgets=[0.05], threads=2)
    assert unmet == [0]
    split = [d for d, row in zip(fine.distances(q), fine.rows) if "post" not in row]
    assert len(split) == 2 and 0.04 < min(split) < 0.05
    assert not fine.collides(q) and hulls.collides(q)
    assert fine.vertices < 40

    # If the parts are far, one more row, that of the hulls, replaces theirs. d does not jump anywhere.
    handing = fcl_stpbv.Robot(*files, r=0.001, hand_over=0.2).model_for(needs, budgets=[0.05])[0]
    assert len(handing.rows) == len(fine.rows) + 1
    far = handing.distances(np.ones(1))
    assert sum(abs(far - 0.15) < 1e-12) == 2  # both parts' rows are constant at 3/4 of the distance
    path = np.linspace(-0.05, 1, 2000)[:, None]
    d, jacobian = handing.evaluate_many(path, path=True)
    assert abs(np.diff(d, axis=0)).max() < 2 * 1.05 / 2000  # slopes are at most 2
    hit = handing.first_hit(q, margin=0.06)  # an index into rows, which include that of the hulls
    assert hit is not None and 0.04 < handing.distances(q)[hit] <= 0.06
    with pytest.raises(fcl_stpbv.Error, match="^hand_over: got -1.0, .* above 0"):
        fcl_stpbv.Robot(*files, hand_over=-1)
    with pytest.raises(fcl_stpbv.Error, match="^influence: got -1.0, .* above 0"):
        fcl_stpbv.Robot(*files, influence=-1)


OTHERS_SRDF = "<robot name='other'><disable_collisions link1='nowhere' link2='block' reason='Never'/></robot>"


def test_what_loading_warns_of_is_raised_and_kept(hook):
    (hook / "other.srdf").write_text(OTHERS_SRDF)
    urdf = hook / "hook.urdf"
    urdf.write_text(urdf.read_text().replace("</robot>", "<link name='seen'><visual><geometry><sphere radius='1'/></geometry></visual></link>"
                                             "<joint name='j' type='fixed'><parent link='l'/><child link='seen'/></joint></robot>"))
    (hook / "post.urdf").write_text((hook / "post.urdf").read_text().replace("collision>", "visual>"))
    told = (r"^.*other.srdf.*'nowhere'", "^.*other.srdf.*'other'", r'^.*hook.urdf: 1 link has visual shapes but no collision shape, .*"seen"',
            "^.*post.urdf: .*visual")
    loaders: list[tuple[Callable, tuple[int, ...]]] = [
        (lambda: fcl_stpbv.Robot(urdf, hook / "other.srdf", hook / "post.urdf"), (0, 1, 2, 3)),
        (lambda: fcl_stpbv.PostureSearch(urdf, hook / "other.srdf", hook / "post.urdf"), (0, 1, 2, 3)),
        (lambda: fcl_stpbv.PairSearch(urdf, hook / "post.urdf"), (2, 3))]
    for load, at in loaders:
        with pytest.warns(UserWarning) as raised:
            robot = load()
        assert [str(warning.message) for warning in raised] == robot.warnings
        assert {warning.filename for warning in raised} == {__file__}  # the line that made the robot
        assert all(any(re.search(told[i], text) for text in robot.warnings) for i in at), robot.warnings
        with warnings.catch_warnings(), pytest.raises(UserWarning):
            warnings.simplefilter("error")
            load()
    # A model of the robot has the warnings about its bodies, and raises none again.
    with warnings.catch_warnings(record=True):
        robot = fcl_stpbv.Robot(urdf, hook / "other.srdf")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert robot.model_for([])[0].warnings == robot.warnings != []
        clean = fcl_stpbv.Robot(DATA / "hrp2_style/hrp2_style.urdf", DATA / "hrp2_style/hrp2_style.srdf")
        assert clean.warnings == []


def test_an_srdf_that_leaves_out_no_pair_is_told_where_joints_hold_some_together(hook):
    arm = DATA / "hrp2_style/hrp2_style.urdf"
    (hook / "nothing.srdf").write_text("<robot name='hrp2_style'/>")
    loaders: list[Callable] = [fcl_stpbv.Robot, fcl_stpbv.PostureSearch]
    for load in loaders:
        with pytest.warns(UserWarning, match="nothing.srdf: leaves out no pair of links, so [0-9]+ pairs of adjacent or rigidly joined ones are checked too"):
            load(arm, hook / "nothing.srdf")


def test_joints_that_stand_still_and_covers_of_a_larger_r_are_told(hook):
    urdf = hook / "still.urdf"
    urdf.write_text((hook / "hook.urdf").read_text().replace("lower='-1' upper='1'", "lower='0' upper='0'"))
    with pytest.warns(UserWarning, match="still.urdf: the joint 'slide' has no range between its limits, so it never moves"):
        fcl_stpbv.Robot(urdf, hook / "hook.srdf")
    with pytest.warns(UserWarning, match="hook.urdf: the joint 'slide' stands still in the neutral posture, as all obstacles do"):
        fcl_stpbv.Robot(hook / "post.urdf", None, hook / "hook.urdf", base="floating")
    ball = "<link name='l{0}'><collision><geometry><box size='1 1 1'/></geometry></collision></link>"
    (hook / "boxes.urdf").write_text("<robot name='boxes'>" + ball.format(1) + ball.format(2) + "<joint name='j' type='prismatic'><parent link='l1'/>"
                                     "<child link='l2'/><limit lower='2' upper='3' effort='1' velocity='1'/></joint></robot>")
    with pytest.warns(UserWarning, match=r"boxes.urdf: R = 0.5 m is too small for the smooth cover of 'l[12]', which has R = .* m instead; give a larger R\.$"):
        fcl_stpbv.Robot(hook / "boxes.urdf", hook / "hook.srdf", R=0.5)


def test_a_model_tells_that_the_parts_of_an_open_mesh_do_not_fill_it(hook):
    lines = (hook / "l.obj").read_text().splitlines()
    (hook / "l.obj").write_text("\n".join(lines[:-1]) + "\n")  # without its last triangle
    robot = fcl_stpbv.Robot(hook / "hook.urdf", hook / "hook.srdf", r=0.001)
    with pytest.warns(UserWarning, match="hook.urdf: the convex parts of 'l' cover faces, but not the space inside") as raised:
        model, _ = robot.model_for([("l", "block", np.zeros(1), 0.04)])
    assert model.warnings == robot.warnings + [str(warning.message) for warning in raised] and len(raised) == 1


def test_a_warning_names_a_file_whatever_bytes_its_name_has(hook):
    name = os.fsencode(hook) + b"/no\xff.srdf"  # not UTF-8
    with open(name, "w") as file:
        file.write(OTHERS_SRDF)
    with pytest.warns(UserWarning, match=re.escape(os.fsdecode(name))):
        robot = fcl_stpbv.Robot(hook / "hook.urdf", name)
    assert all(text.startswith(os.fsdecode(name)) for text in robot.warnings)


def test_velocities_and_weights_whose_products_overflow_raise():
    robot = fcl_stpbv.Robot(DATA / "hrp2_style/hrp2_style.urdf", DATA / "hrp2_style/hrp2_style.srdf")
    q, weights = robot.neutral, np.ones(len(robot.rows))
    with pytest.raises(fcl_stpbv.Error, match="qd: .*1e100"):
        robot.rates(q, 1e200 + 0 * q)
    with pytest.raises(fcl_stpbv.Error, match="v: .*1e100"):
        robot.hessian_vector(q, weights, 1e200 + 0 * q)
    with pytest.raises(fcl_stpbv.Error, match="weights: .*1e100"):
        robot.hessian_vector(q, 1e200 * weights, q)
    with pytest.raises(fcl_stpbv.Error, match="weights: .*1e100"):
        robot.hessian(q, -1e308 * weights)


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
def test_options_that_are_not_finite_raise(bad):
    urdf = DATA / "hrp2_style" / "hrp2_style.urdf"
    for options in ({"r": bad}, {"R": bad}):
        with pytest.raises(fcl_stpbv.Error):
            fcl_stpbv.StpBv.build(BOX, **options)
        with pytest.raises(fcl_stpbv.Error):
            fcl_stpbv.Robot(urdf, **options)
    if bad != math.inf:  # inf is the default
        with pytest.raises(fcl_stpbv.Error, match="influence"):
            fcl_stpbv.Robot(urdf, influence=bad)


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
def test_numbers_that_are_not_finite_raise(bad):
    volume = box()
    for ask in (volume.support, volume.surface_point, volume.signed_distance):
        with pytest.raises(fcl_stpbv.Error, match="not finite"):
            ask([bad, 0, 0])
    with pytest.raises(fcl_stpbv.Error, match="zero"):
        volume.support([0, 0, 0])
    assert volume.support([1e300, 0, 0]) == pytest.approx(volume.support([1, 0, 0]), abs=1e-15)
    folder = DATA / "hrp2_style"
    robot = fcl_stpbv.Robot(str(folder / "hrp2_style.urdf"), str(folder / "hrp2_style.srdf"))
    q = robot.neutral.copy()
    q[3] = bad
    good, weights = robot.neutral, np.ones(len(robot.rows))
    broken = weights.copy()
    broken[0] = bad
    for ask in (lambda: robot.collides(q), lambda: robot.first_hit(q), lambda: robot.min_distance(q),
                lambda: robot.collides_many([good, q]), lambda: robot.evaluate_many([q]), lambda: robot.distances_many([q])):
        with pytest.raises(fcl_stpbv.Error, match="not finite"):
            ask()
    for ask in (lambda: robot.evaluate(q), lambda: robot.distances(q), lambda: robot.rates(q, good), lambda: robot.rates(good, q),
                lambda: robot.hessian(q, weights), lambda: robot.hessian(good, broken),
                lambda: robot.hessian_vector(q, weights, good), lambda: robot.hessian_vector(good, broken, good),
                lambda: robot.hessian_vector(good, weights, q)):
        with pytest.raises(fcl_stpbv.Error, match="not finite"):
            ask()
