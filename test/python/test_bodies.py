"""What volumes a Robot's links get: its r, R, links and flat mean what the tools' options do, and give the same distances."""
import json
import os
import pathlib
import subprocess

import numpy as np
import pytest

import fcl_stpbv

DATA = pathlib.Path(os.environ.get("FCL_STPBV_DATA", pathlib.Path(__file__).parents[2] / "data"))
FILES = DATA / "hrp2_style/hrp2_style.urdf", DATA / "hrp2_style/hrp2_style.srdf"
REPORT = pathlib.Path(fcl_stpbv.__file__).parents[2] / "bin/urdf_collision_report"


@pytest.fixture(scope="module")
def wall(tmp_path_factory):
    """A flat mesh in front of the robot."""
    folder = tmp_path_factory.mktemp("wall")
    corners = [(x, y, z) for x in (1.0, 1.1) for y in (-1.0, 1.0) for z in (-1.0, 1.0)]
    (folder / "wall.obj").write_text("".join(f"v {x} {y} {z}\n" for x, y, z in corners) + "f 1 2 4\nf 1 4 3\nf 5 7 8\nf 5 8 6\nf 1 5 6\nf 1 6 2\n"
                                     "f 3 4 8\nf 3 8 7\nf 1 3 7\nf 1 7 5\nf 2 6 8\nf 2 8 4\n")
    (folder / "wall.urdf").write_text("<robot name='wall'><link name='wall'><collision><geometry><mesh filename='wall.obj'/></geometry></collision></link></robot>")
    return folder / "wall.urdf"


def reported(options, wall):
    """Distances of each checked pair of links, and of links and obstacles, in half_sitting."""
    command = [REPORT, FILES[0], "--srdf", FILES[1], "--obstacles", wall, "--pose", "half_sitting", "--samples", "1", "-q", "--format", "json"]
    done = subprocess.run([*map(str, command), *options], capture_output=True, text=True, timeout=120)
    assert done.returncode in (0, 1), done.stderr
    return {(pair["link1"], pair["link2"] or pair["obstacle"]): pair["distance"] for pair in json.loads(done.stdout)["pairs"] if pair["checked"]}


@pytest.mark.skipif(not REPORT.exists(), reason="urdf_collision_report is not built")
@pytest.mark.parametrize("options, given", [
    (["-r", "0.01"], {}),
    ([], {"r": "auto"}),
    (["-R", "5"], {"r": "auto", "R": 5}),
    (["-r", "0.003", "-R", "auto"], {"r": 0.003, "R": "auto"}),
    (["-r", "0.01", "--link", "LARM_LINK6=0.001,3", "--link", "HEAD_LINK1=0.02,20,0.03"],
     {"links": {"LARM_LINK6": (0.001, 3.0), "HEAD_LINK1": [0.02, 20, 0.03]}}),
    (["-r", "0.01", "--flat", "LARM_LINK6", "--flat", "obstacles"], {"flat": ["LARM_LINK6", "obstacles"]}),
    (["--flat", "obstacles"], {"r": "auto", "flat": "obstacles"})], ids=" ".join)
def test_a_robot_has_the_distances_of_the_report_with_the_same_options(options, given, wall):
    robot = fcl_stpbv.Robot(*FILES, wall, **given)
    q, usual = robot.configuration("half_sitting"), fcl_stpbv.Robot(*FILES, wall)
    expected, found = reported(options, wall), dict[tuple[str, ...], float]()
    for row, d in zip(robot.rows, robot.distances(q)):
        links = tuple(name.split("#")[0] for name in row.split(" - "))
        found[links] = min(d, found.get(links, np.inf))
    assert found.keys() == expected.keys()
    for links, d in found.items():
        assert d == pytest.approx(expected[links], abs=1e-9), links  # what the report writes
    if given:
        assert abs(robot.distances(q) - usual.distances(q)).max() > 1e-4


def test_a_model_for_needs_keeps_the_bodies_that_were_asked_for(wall):
    given = {"links": {"LARM_LINK6": (0.001, 3.0)}, "flat": ["obstacles"]}
    robot = fcl_stpbv.Robot(*FILES, wall, **given)  # type: ignore[arg-type]
    model, unmet = robot.model_for([])
    assert unmet == [] and model.rows == robot.rows
    np.testing.assert_allclose(model.distances(robot.neutral), robot.distances(robot.neutral), rtol=0, atol=1e-13)


@pytest.mark.parametrize("given, told", [
    ({"r": "fitted"}, '^r: got "fitted", expected a length .* or "auto"'), ({"R": "fitted"}, '^R: got "fitted"'),
    ({"links": {"HEAD_LINK1": (0.01,)}}, r'^links: "HEAD_LINK1": got 1 numbers, expected \(r, R\)'), ({"links": {"HEAD_LINK1": (2.0, 1.0)}}, "^links: .*R must be larger"),
    ({"links": {"HEAD_LINK1": (float("nan"), 1.0)}}, "^links: "), ({"links": {"HEAD_LINK1": (-1.0, 1.0)}}, "r of link 'HEAD_LINK1'"),
    ({"links": {"nobody": (0.01, 1.0)}}, "a link 'nobody' it does not have"), ({"flat": ["nobody"]}, "a link 'nobody' it does not have"),
    ({"flat": "obstacles"}, "^flat: there are no obstacles"), ({"flat": ["HEAD_LINK1"], "links": {"HEAD_LINK1": (0.01, 1.0)}}, '^flat: "HEAD_LINK1"'),
    ({"r": 1.0, "R": 0.5}, "R: got 0.5")])
def test_options_of_bodies_that_make_no_sense_are_refused(given, told):
    with pytest.raises(fcl_stpbv.Error, match=told):
        fcl_stpbv.Robot(*FILES, **given)
