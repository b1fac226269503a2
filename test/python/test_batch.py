"""Batches: pure pieces, results that do not depend on who did which job, what goes wrong with one job or its input."""
import contextlib
import functools
import itertools
import json
import os
import pathlib
import random
import re
import resource
import shutil
import socket
import subprocess
import sys

import numpy as np
import pytest

import fcl_stpbv
import warm_start

DATA = pathlib.Path(os.environ.get("FCL_STPBV_DATA", pathlib.Path(__file__).parents[2] / "data"))
HRP2 = DATA / "hrp2_style"
TOOLS = DATA.parent / "test/tools"
ARM = TOOLS / "six_joint_arm.urdf"
MESH_TO_STPBV = pathlib.Path(fcl_stpbv.__file__).parents[2] / "bin/mesh_to_stpbv"
PROVE = ["prove", ARM, "--budget", "10", "--boxes", "500", "--descents", "1"]  # several rounds for most pairs


def cold_start(*arguments, **more):
    """Runs a batch in an interpreter of its own."""
    return subprocess.run([sys.executable, "-B", "-m", "fcl_stpbv.batch", *map(str, arguments)], capture_output=True, text=True, timeout=120, **more)


def batch(*arguments, status=0, start=functools.partial(warm_start.run, "fcl_stpbv.batch", timeout=120), **more):
    """Runs a batch; its summary, or what it complains about."""
    done = start(*arguments, **more)
    assert done.returncode == status, done.stderr
    assert "Traceback" not in done.stderr
    return done.stdout if status == 0 else done.stderr


@pytest.fixture(scope="module")
def arm():
    return fcl_stpbv.PairSearch(str(ARM))


@pytest.fixture(scope="module")
def proofs(tmp_path_factory):
    """The results of one process for the arm's pairs."""
    path = tmp_path_factory.mktemp("one") / "proofs.jsonl"
    batch(*PROVE, "--jobs", 1, "-o", path, start=cold_start)
    return path


def test_what_loading_warns_of_is_told_once_by_whoever_begins(tmp_path):
    urdf = tmp_path / "arm.urdf"
    ghost = "<link name='ghost'><visual><geometry><sphere radius='1'/></geometry></visual></link>"
    joint = "<joint name='ghost_joint' type='fixed'><parent link='{}'/><child link='ghost'/></joint></robot>"
    text = ARM.read_text()
    urdf.write_text(text.replace("</robot>", ghost + joint.format(re.findall('<link name="([^"]*)"', text)[0])))
    command = ["sample", urdf, "--blocks", "4", "--count", "1", "--jobs"]
    told = f'fcl_stpbv.batch: {urdf}: 1 link has visual shapes but no collision shape, so nothing checks it: "ghost".\n'
    for more, expected in (["1"], told), (["2"], told), (["1", "-q"], ""):
        done = cold_start(*command, *more, "-o", tmp_path / "-".join(more))
        assert (done.returncode, done.stderr) == (0, expected)


def test_radii_that_fit_each_link_are_those_of_the_python_searches(tmp_path):
    robot = tmp_path / "bodies.urdf"
    link = f"<link name='{{}}'><collision><geometry><mesh filename='{HRP2}/meshes/{{}}'/></geometry></collision></link>"
    joint = ("<joint name='to_{1}' type='prismatic'><parent link='{0}'/><child link='{1}'/><origin xyz='1 0 0'/><axis xyz='0 0 1'/>"
             "<limit lower='-1' upper='1' effort='1' velocity='1'/></joint>")
    robot.write_text("<robot name='bodies'>" + link.format("a", "LARM_LINK6.stl") + link.format("b", "BODY.dae") + link.format("c", "LARM_LINK6.stl")
                     + joint.format("a", "b") + joint.format("b", "c") + "</robot>")
    sample = ["sample", robot, "--blocks", 2, "--count", 5, "--jobs", 1]

    def least(name, *more):
        batch(*sample, "-o", tmp_path / name, *more)
        header, *blocks = map(json.loads, (tmp_path / name).read_text().splitlines())
        return (header["r"], header["R"]), [block["least"] for block in blocks]

    def expected(**radii):
        search = fcl_stpbv.PairSearch(robot, **radii)
        assert search.pairs == [("a", "c")]
        return [[pair[1] for pair in search.sample(1, block, 5)] for block in range(2)]

    all_radii = [expected(r="auto"), expected(r="auto", R=10.0), expected(R="auto"), expected()]
    assert len({str(distances) for distances in all_radii}) == 4
    assert least("r", "-r", "auto") == (("auto", "auto"), all_radii[0])
    least("both", "-r", "auto", "-R", "auto")
    assert (tmp_path / "r").read_bytes() == (tmp_path / "both").read_bytes()
    assert least("far", "-r", "auto", "-R", 10) == (("auto", 10.0), all_radii[1])
    assert least("near", "-R", "auto") == ((0.01, "auto"), all_radii[2])
    assert least("usual") == ((0.01, 10.0), all_radii[3])
    assert "a different R" in batch(*sample, "-r", "auto", "-R", 10, "-o", tmp_path / "r", status=2)
    batch("prove", robot, "-r", "auto", "--jobs", 1, "-o", tmp_path / "proofs", "--write-srdf", tmp_path / "proven.srdf")
    assert "(r = auto, R = auto)" in (tmp_path / "proven.srdf").read_text()
    batch("postures", ARM, TOOLS / "reach.json", "-r", "auto", "--starts", 1, "--jobs", 1, "-o", tmp_path / "postures")
    job = json.loads((tmp_path / "postures").read_text().splitlines()[1])
    alone = fcl_stpbv.PostureSearch(ARM, r="auto").solve((TOOLS / "reach.json").read_text(), start=0, seed=1)
    assert (job["q"], job["cost"]) == (alone["q"], alone["cost"])
    for mistake, what in ((["-r", "Auto"], "got Auto, expected a number from 0 to 1000000.0 m or 'auto'"), (["-R", "-1"], "or 'auto'")):
        assert what in batch(*sample, *mistake, "-o", tmp_path / "none", status=2)


@pytest.mark.skipif(not MESH_TO_STPBV.exists(), reason="mesh_to_stpbv is not built")
@pytest.mark.parametrize("radii, same", [(["-r", "auto"], {"r": "auto"}), (["-r", "auto", "-R", "5"], {"r": "auto", "R": 5}), (["-R", "auto"], {"R": "auto"})])
def test_a_mesh_is_converted_with_radii_that_fit_it_as_mesh_to_stpbv_does(tmp_path, radii, same):
    mesh, alone = HRP2 / "meshes/BODY.dae", tmp_path / "alone.stpbv"
    batch("convert", mesh, *radii, "--volumes", tmp_path / "volumes", "-o", tmp_path / "out", "--jobs", 1)
    subprocess.run([MESH_TO_STPBV, mesh, *radii, "-o", alone, "-q"], check=True)
    assert (tmp_path / "volumes/BODY.stpbv").read_bytes() == alone.read_bytes()
    volume, written = fcl_stpbv.StpBv.build(fcl_stpbv.load_points(mesh), **same), fcl_stpbv.StpBv.load(alone)
    assert (0.01, 10) != (volume.r, volume.R) == (written.r, written.R)
    with pytest.raises(fcl_stpbv.Error, match='^R: got "fit", expected a length .* or "auto"'):
        fcl_stpbv.StpBv.build(volume.vertices, R="fit")


def bits(proof):
    return [[limits.tolist() for limits in box] for box in proof.open], None if proof.collision is None else proof.collision.tolist(), proof.boxes


def test_merging_proofs_is_associative_and_commutative(arm):
    generator = random.Random(1)
    merged_with_collision = 0
    for pair in range(0, len(arm.pairs), 3):
        pieces = [arm.prove(pair, arm.unproven(pair).open, 7)]
        pieces += [arm.prove(pair, [box], 5) for box in pieces[0].open[:3]]
        dimension = len(arm.unproven(pair).open[0][0])
        pieces.append(fcl_stpbv.PairProof([], np.array([generator.random() for _ in arm.names]), 3))
        pieces.append(fcl_stpbv.PairProof([(np.zeros(dimension), np.ones(dimension))], None, 1))
        for a, b, c in itertools.permutations(pieces, 3):
            assert bits(a.merge(b)) == bits(b.merge(a))
            assert bits(a.merge(b).merge(c)) == bits(a.merge(b.merge(c)))
            merged_with_collision += a.merge(b).collision is not None
    assert merged_with_collision > 0


def test_a_piece_is_the_same_whatever_was_asked_before(arm):
    fresh = fcl_stpbv.PairSearch(str(ARM))
    pair = len(arm.pairs) - 1
    for other in range(len(arm.pairs)):
        arm.prove(other, arm.unproven(other).open, 20)
        arm.sample(1, other, 3)
    assert bits(arm.prove(pair, arm.unproven(pair).open, 50)) == bits(fresh.prove(pair, fresh.unproven(pair).open, 50))
    ask = lambda search, block: [(hits, least, q.tolist()) for hits, least, q in search.sample(1, block, 20)]
    assert ask(arm, 4) == ask(fresh, 4) != ask(fresh, 5)


@pytest.mark.parametrize("box", [([0.0], [0.0, 1.0]), ([1.0], [0.0]), ([float("nan")], [1.0])])
def test_a_box_that_is_none_is_refused(arm, box):
    with pytest.raises(fcl_stpbv.Error, match="^boxes: "):
        fcl_stpbv.PairProof([box])
    with pytest.raises(fcl_stpbv.Error, match="^boxes: "):
        arm.prove(0, [box], 1)


def test_a_count_below_zero_is_refused():
    with pytest.raises(fcl_stpbv.Error, match="boxes"):
        fcl_stpbv.PairProof([], None, -1)


@pytest.mark.parametrize("margin", [float("nan"), float("inf"), -1e7])
def test_a_margin_that_is_no_length_is_refused(margin):
    with pytest.raises(fcl_stpbv.Error, match="margin: got"):  # nothing collides within a margin that is not a number
        fcl_stpbv.PairSearch(str(ARM), margin=margin)


def test_a_posture_is_that_of_find_posture_with_flat_primitives():
    task = TOOLS / "reach.json"
    options = "-r 0.01 -R 10 --primitives flat --starts 1 --no-cache -q --format json".split()
    program = [str(MESH_TO_STPBV.with_name("find_posture")), str(ARM), str(task), *options]
    found = json.loads(subprocess.run(program, capture_output=True, check=True).stdout)
    posture = fcl_stpbv.PostureSearch(ARM).solve(task.read_text())
    assert posture["feasible"] and posture["q"] == list(found["q"].values()) and posture["cost"] == found["cost"]


def test_a_posture_is_the_same_whatever_was_asked_before():
    task = (TOOLS / "reach.json").read_text()
    search, fresh = (fcl_stpbv.PostureSearch(str(ARM)) for _ in range(2))
    for start in (2, 0, 1):
        search.solve(task, start=start)
    assert search.solve(task, start=1) == fresh.solve(task, start=1) != fresh.solve(task, start=2)
    found = fresh.solve(task)
    again = fresh.solve(task, start_from=np.array(found["q"]))
    assert found["feasible"] and again["feasible"] and again["iterations"] <= found["iterations"]
    with pytest.raises(fcl_stpbv.Error, match="start_from: got 1"):
        fresh.solve(task, start_from=np.zeros(1))


def test_proofs_agree_with_samples_and_collisions_collide(proofs, arm):
    robot = fcl_stpbv.Robot(str(ARM))
    rows = {name: i for i, name in enumerate(robot.rows)}
    least = dict(zip(arm.pairs, (pair[1] for pair in arm.sample(7, 0, 2000))))
    by_pair: dict[tuple, list] = {}
    for record in map(json.loads, proofs.read_text().splitlines()[1:]):
        by_pair.setdefault(tuple(record["job"][:2]), []).append(record)
    assert set(by_pair) == set(arm.pairs)
    for pair, records in by_pair.items():
        collisions = [record["collision"] for record in records if record["collision"]]
        for q in collisions:  # the covers of the robot's primitives contain them, so their distance is not above theirs
            assert min(robot.distances(np.array(q))[i] for name, i in rows.items() if set(name.split(" - ")) == set(pair)) <= 0
        last = max(record["job"][2] for record in records)
        proven = not collisions and not any(record["open"] for record in records if record["job"][2] == last)
        assert not (proven and least[pair] <= 0)


def test_names_that_are_not_utf8_are_told(tmp_path):
    for old, places in ((b"forearm", ("sample", "prove")), (b"joint3", ("postures",))):
        urdf = tmp_path / "latin.urdf"
        urdf.write_bytes(ARM.read_bytes().replace(old, b"\xe9t\xe9"))
        for kind in places:
            message = batch(kind, urdf, *([TOOLS / "reach.json"] if kind == "postures" else []), "--jobs", 1, "-o", tmp_path / kind, status=2)
            assert message == f"fcl_stpbv.batch: {urdf}: a name in it or in its obstacles is not UTF-8; save the files in UTF-8\n"


def test_a_pair_across_a_floating_joint_is_never_proven(tmp_path):
    ball = '<collision><geometry><sphere radius="0.1"/></geometry></collision>'
    (tmp_path / "free.urdf").write_text(f"""<robot name="free"><link name="a">{ball}</link><link name="m"/><link name="b">{ball}</link>
        <joint name="j" type="floating"><parent link="a"/><child link="m"/></joint>
        <joint name="k" type="revolute"><parent link="m"/><child link="b"/><origin xyz="0.5 0 0"/><axis xyz="0 0 1"/>
        <limit lower="-1" upper="1" effort="1" velocity="1"/></joint></robot>""")
    prove = ["prove", tmp_path / "free.urdf", "--jobs", 1]
    assert "1 pairs: 1 without limits" in batch(*prove, "--descents", 0, "-o", tmp_path / "none")
    assert "1 pairs: 1 colliding" in batch(*prove, "-o", tmp_path / "some")


@pytest.mark.parametrize("shards", [2, 5])
def test_shards_merged_in_any_order_are_what_one_process_finds(proofs, tmp_path, shards):
    parts = [tmp_path / f"{i}.jsonl" for i in range(shards)]
    for i, part in enumerate(parts):
        batch(*PROVE, "--shard", f"{i}/{shards}", "-o", part)
    for name, order in (("a", parts), ("b", parts[::-1])):
        batch(*PROVE, "--merge", *order, "-o", tmp_path / name)
        assert (tmp_path / name).read_bytes() == proofs.read_bytes()
    assert "missing" in batch(*PROVE, "--merge", parts[0], "-o", tmp_path / "c", status=1)


def test_shards_go_on_from_merged_results(proofs, tmp_path):
    few = [*PROVE[:5], "20", *PROVE[6:]]
    batch(*few, "--jobs", 1, "-o", tmp_path / "first")
    parts = [tmp_path / "0", tmp_path / "1"]
    for number in range(8):  # if several shards have jobs of a round, the next round is known only after merging
        for i, part in enumerate(parts):
            batch(*PROVE, "--shard", f"{i}/2", "--merge", tmp_path / "first", "-o", part)
        merged = warm_start.run("fcl_stpbv.batch", *PROVE, "--merge", *parts, "-o", tmp_path / "all", timeout=120)
        for part in parts:
            part.unlink()
        shutil.move(tmp_path / "all", tmp_path / "first")
        if merged.returncode == 0:
            break
    assert (tmp_path / "first").read_bytes() == proofs.read_bytes() and number < 7


def test_closed_streams_cost_no_result(proofs, tmp_path):
    def run(closed, *more):
        out = tmp_path / f"{closed}{len(more)}"
        command = [sys.executable, "-B", "-m", "fcl_stpbv.batch", *map(str, PROVE), "--jobs", "1", "-o", out, *more]
        done = subprocess.run(["sh", "-c", f'exec "$@" {closed}', "sh", *command], capture_output=True, text=True, timeout=120)
        assert out.read_bytes() == proofs.read_bytes()
        return done.returncode, done.stderr

    assert run("<&- >&- 2>&-", "-q") == run("<&- 2>&-") == (0, "")
    status, message = run(">&-")
    assert status == 2 and message.startswith("fcl_stpbv.batch: standard output: cannot be written") and message.count("\n") == 1


def test_an_interrupted_run_goes_on_to_the_same_bytes(proofs, tmp_path):
    whole = proofs.read_bytes()
    part = tmp_path / "part.jsonl"
    for cut in (whole.index(b"\n") + 1, len(whole) // 2, len(whole) - 1):
        part.write_bytes(whole[:cut])
        batch(*PROVE, "--jobs", 1, "-o", part)
        assert part.read_bytes() == whole


def test_two_processes_find_what_one_does(tmp_path):
    sample = ["sample", ARM, "--blocks", 6, "--count", 50]
    task = [*("postures", ARM, TOOLS / "reach.json"), "--starts", 2]
    for name, arguments in (("sample", sample), ("postures", task)):
        batch(*arguments, "--jobs", 1, "-o", tmp_path / f"{name}1")
        batch(*arguments, "--jobs", 2, "-o", tmp_path / f"{name}2", start=cold_start)
        assert (tmp_path / f"{name}1").read_bytes() == (tmp_path / f"{name}2").read_bytes()


def gltf(uri, **more):
    """A cube of 1 m whose corners are in a file of this name, and the contents of that file."""
    corners = np.array(list(itertools.product((0, 1), repeat=3)), np.float32)
    document = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
                "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
                "accessors": [{"bufferView": 0, "componentType": 5126, "count": 8, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 1]}],
                "bufferViews": [{"buffer": 0, "byteLength": 96}], "buffers": [{"byteLength": 96, "uri": uri}], **more}
    return json.dumps(document), corners.tobytes()


def cube(path, uri, name=None):
    """Writes such a mesh and its buffer. The buffer's file is called `name` if that differs from the name in the mesh."""
    text, corners = gltf(uri)
    path.write_text(text)
    buffer = path.parent / (name or uri)
    buffer.parent.mkdir(parents=True, exist_ok=True)
    buffer.write_bytes(corners)
    return path


def test_the_buffers_of_a_gltf_travel_from_below_its_folder(tmp_path, here_or_there):
    places = {"a": ("a.bin",), "b": ("sub/b.bin",), "c": ("./sub/../sub/deep/c.bin", "sub/deep/c.bin"),
              "d": ("sub%20of/d%2525.bin", "sub of/d%25.bin"), "e": ("volume/e.bin",), "f": ("sub\\f.bin", "sub/f.bin"), "g": ("as%20is.bin",)}
    meshes = [cube(tmp_path / f"{name}.gltf", *place) for name, place in places.items()]
    batch("convert", *meshes, "--volumes", tmp_path / "volumes", *here_or_there, "-o", tmp_path / "out")
    for name in places:
        assert len(fcl_stpbv.StpBv.load(str(tmp_path / f"volumes/{name}.stpbv")).vertices) == 8
    limits = '<axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="1" velocity="1"/>'
    (tmp_path / "two.urdf").write_text(f"""<robot name="two">
        <link name="a"><collision><geometry><mesh filename="b.gltf"/></geometry></collision></link><link name="m"/>
        <link name="b"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
        <joint name="i" type="revolute"><parent link="a"/><child link="m"/><origin xyz="3 0 0"/>{limits}</joint>
        <joint name="j" type="revolute"><parent link="m"/><child link="b"/><origin xyz="0.5 0 0"/>{limits}</joint></robot>""")
    batch("sample", tmp_path / "two.urdf", "--blocks", 3, "--count", 2, *here_or_there, "-o", tmp_path / "samples")


def test_no_buffer_is_read_from_elsewhere_and_a_damaged_gltf_fails_its_own_job(tmp_path):
    from fcl_stpbv.batch import bundle

    folder, corners = tmp_path / "meshes", gltf("")[1]
    folder.mkdir()
    (tmp_path / "far.bin").write_bytes(corners)
    (folder / "link.bin").symlink_to("../far.bin")
    os.mkfifo(folder / "pipe.bin")
    for i, uri in enumerate(["../far.bin", "%2e%2e/far.bin", "x/../../far.bin", str(tmp_path / "far.bin"), "link.bin", "pipe.bin", "..", "", "no.bin",
                             "a\0b", "\ud800", 5, None]):
        mesh = folder / f"{i}.gltf"
        mesh.write_text(gltf(uri)[0])
        assert [name for name, _ in bundle.mesh_entries(mesh)] == [mesh.name], uri
    for name, text in [("list", "[]"), ("number", gltf("", buffers=5)[0]), ("texts", gltf("", buffers=["a"])[0]), ("deep", "[" * 200000)]:
        (folder / f"{name}.gltf").write_text(text)
    meshes = sorted(folder.glob("*.gltf"))
    message = batch("convert", *meshes, folder / "pipe.bin", "--volumes", tmp_path / "volumes", "--jobs", 1, "-o", tmp_path / "out", status=1)
    assert all(str(mesh) in message for mesh in meshes) and "pipe.bin: is a folder, a pipe or a device, expected a file" in message
    (tmp_path / "away").mkdir()
    cube(tmp_path / "away/real.gltf", "beside.bin")
    (folder / "mesh.gltf").symlink_to("../away/real.gltf")  # files beside a link's target belong to the mesh
    (folder / "beside.bin").symlink_to("../away/beside.bin")
    assert dict(bundle.mesh_entries(folder / "mesh.gltf"))["beside.bin"] == corners
    (tmp_path / "away/old.gltf").write_text(gltf("", buffers={"b": {"uri": "beside.bin"}})[0])  # as glTF 1.0 lists them
    assert dict(bundle.mesh_entries(tmp_path / "away/old.gltf"))["beside.bin"] == corners


def test_a_robot_travels_with_its_meshes(tmp_path):
    from fcl_stpbv.batch import bundle

    urdf = HRP2 / "hrp2_style.urdf"
    files = bundle.robot_files("robot", urdf, [])
    with bundle.Unpacked(files) as folder:
        moved = fcl_stpbv.PairSearch(str(folder / "robot/robot.urdf"))
        here = fcl_stpbv.PairSearch(str(urdf))
        assert moved.pairs == here.pairs and moved.sample(1, 0, 3)[0][1] == here.sample(1, 0, 3)[0][1]
        assert all(str(folder) in path for _, path in fcl_stpbv.mesh_files(str(folder / "robot/robot.urdf")))
    assert bundle.digest_of(files) == bundle.digest_of(dict(reversed(files.items())))
    assert bundle.digest_of(files) != bundle.digest_of({**files, "robot/robot.urdf": files["robot/robot.urdf"] + b" "})


@pytest.mark.parametrize("name", [" in front.stl", "behind.stl ", "a&b'c.stl"])
def test_a_mesh_travels_under_any_name(tmp_path, name):
    from fcl_stpbv.batch import bundle

    shutil.copy(HRP2 / "meshes/LARM_LINK0.stl", tmp_path / name)
    (tmp_path / "one.urdf").write_text(f"""<robot name="one"><link name="a"><collision><geometry>
        <!-- filename=" --><mesh filename="{name.replace('&', '&amp;')}"/>
        </geometry></collision></link></robot>""")
    with bundle.Unpacked(bundle.robot_files("robot", tmp_path / "one.urdf", [])) as folder:
        (_, path), = fcl_stpbv.mesh_files(folder / "robot/robot.urdf")
        assert pathlib.Path(path).read_bytes() == (tmp_path / name).read_bytes() and str(folder) in path


def test_a_bad_mesh_fails_its_own_job_and_no_other(tmp_path, here_or_there):
    bad, missing = tmp_path / "bad.stl", tmp_path / "missing.stl"
    bad.write_bytes(b"solid nothing")
    good = [HRP2 / "meshes/BODY.dae", HRP2 / "meshes/LARM_LINK0.stl"]
    arguments = ["convert", bad, *good, missing, "--volumes", tmp_path / "volumes", "-o", tmp_path / "all"]
    message = batch(*arguments, *here_or_there, status=1)
    assert str(bad) in message and str(missing) in message and "fcl_stpbv_" not in message
    assert sorted(path.name for path in (tmp_path / "volumes").iterdir()) == ["BODY.stpbv", "LARM_LINK0.stpbv"]
    for mesh in good:
        volume = fcl_stpbv.StpBv.load(str(tmp_path / "volumes" / f"{mesh.stem}.stpbv"))
        assert np.array_equal(volume.vertices, fcl_stpbv.StpBv.build(fcl_stpbv.load_points(str(mesh))).vertices)
    results = (tmp_path / "all").read_bytes()
    (tmp_path / "volumes/BODY.stpbv").unlink()
    batch(*arguments, "--jobs", 1, status=1)
    assert (tmp_path / "volumes/BODY.stpbv").exists() and (tmp_path / "all").read_bytes() == results


@pytest.mark.parametrize("room", [250, 600])  # bytes: too little for the mesh, for the volume
def test_a_full_folder_for_temporary_files_is_no_fault_of_the_meshs(tmp_path, room):
    triangles = np.zeros(4, [("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("more", "<u2")])
    triangles["corners"] = np.random.default_rng(1).normal(size=(4, 3, 3))
    (tmp_path / "few.stl").write_bytes(bytes(80) + (4).to_bytes(4, "little") + triangles.tobytes())
    convert = ["convert", "few.stl", "--volumes", "v", "--jobs", 1, "-o", "out"]
    message = batch(*convert, status=1, cwd=tmp_path, start=cold_start,
                    preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (room, resource.RLIM_INFINITY)))
    assert message.startswith("fcl_stpbv.batch: ['few.stl'] has no result: OSError: ") and message.count("\n") == 1, message
    assert "1 volumes, 0 failed" in batch(*convert, cwd=tmp_path)
    assert (tmp_path / "few.stl").stat().st_size < 600 < (tmp_path / "v/few.stpbv").stat().st_size


def test_meshes_are_read_when_their_turn_comes(tmp_path):
    size = 4 << 20

    def memory(count):
        """The largest memory of such a run (bytes)."""
        meshes = [tmp_path / f"{count}_{i}.stl" for i in range(count)]
        for mesh in meshes:
            mesh.write_bytes(bytes(size))
        command = ["convert", *meshes, "--volumes", tmp_path / "volumes", "--jobs", 1, "-o", tmp_path / f"out{count}"]
        run = subprocess.Popen([sys.executable, "-B", "-m", "fcl_stpbv.batch", *map(str, command)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        _, run.returncode, used = os.wait4(run.pid, 0)
        return 1024 * used.ru_maxrss

    assert memory(16) < memory(2) + 5 * size


def test_a_mesh_that_changes_while_a_batch_runs_is_told(tmp_path):
    from fcl_stpbv.batch import __main__ as program, kinds

    mesh = tmp_path / "mesh.stl"
    shutil.copy(HRP2 / "meshes/LARM_LINK0.stl", mesh)
    kind = kinds.Convert(program.described().parse_args(["convert", str(mesh), "--volumes", str(tmp_path / "volumes"), "-o", "out"]))
    (_, given), = kind.jobs(str(mesh), {})
    assert dict(given()) == {"mesh.stl": mesh.read_bytes()}
    for change in (lambda: mesh.write_bytes(b"solid"), mesh.unlink):
        change()
        with pytest.raises(fcl_stpbv.Error, match=f"^{mesh}: has changed"):
            given()


def test_the_over_cover_of_a_conversion_is_over_all_points(tmp_path):
    mesh = HRP2 / "meshes/BODY.dae"
    batch("convert", mesh, "-R", 0.6, "--volumes", tmp_path / "volumes", "-o", tmp_path / "out", "--jobs", 1)
    record = json.loads((tmp_path / "out").read_text().splitlines()[1])
    points, volume = fcl_stpbv.load_points(mesh), fcl_stpbv.StpBv.load(tmp_path / "volumes/BODY.stpbv")
    assert record["over_cover"] == volume.over_cover(points)[0] < volume.over_cover()[0]


def test_another_cluster_on_this_machine_goes_unnoticed(tmp_path):
    with socket.socket() as taken:
        taken.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        with contextlib.suppress(OSError):  # it may be taken already
            taken.bind(("", 8787))  # the default port of a Dask scheduler's pages
            taken.listen()
        done = cold_start("sample", ARM, "--blocks", 2, "--count", 1, "--jobs", 2, "-o", tmp_path / "samples.jsonl")
    assert done.returncode == 0 and "8787" not in done.stderr and "Warning" not in done.stderr, done.stderr


def test_a_volume_that_is_there_stays(tmp_path, here_or_there):
    volumes, mesh = tmp_path / "volumes", tmp_path / "L.stl"
    shutil.copy(HRP2 / "meshes/LARM_LINK0.stl", mesh)
    volumes.mkdir()
    for name in ("L.stpbv", "L.tmp", "other"):
        (volumes / name).write_text("mine")
    convert = ["convert", mesh, HRP2 / "meshes/BODY.dae", "--volumes", volumes, "-o", tmp_path / "out", *here_or_there]
    message = batch(*convert, status=2)
    assert f"{volumes}/L.stpbv: exists already and is another volume" in message and message.count("\n") == 1
    (volumes / "L.stpbv").unlink()
    batch(*convert)  # continues
    written, files = (volumes / "L.stpbv").stat(), sorted(path.name for path in volumes.iterdir())
    assert files == ["BODY.stpbv", "L.stpbv", "L.tmp", "other"] and (volumes / "L.tmp").read_text() == "mine"
    (tmp_path / "out").unlink()
    batch(*convert)  # like a run that was killed before it could note the volume
    assert (volumes / "L.stpbv").stat() == written
    (volumes / "L.stpbv").write_text("mine")  # differs from the recorded result
    assert "L.stpbv: exists already" in batch(*convert, status=2) and (volumes / "L.stpbv").read_text() == "mine"


def test_a_file_is_written_whole_or_not_at_all(tmp_path):
    from fcl_stpbv.batch import results

    def broken():
        yield b"half"
        raise KeyboardInterrupt

    (tmp_path / "folder").mkdir()
    (tmp_path / "file").write_text("before")
    (tmp_path / "file").chmod(0o640)
    (tmp_path / "folder/link").symlink_to("../file")
    with pytest.raises(fcl_stpbv.Error, match="--volumes .*folder: cannot be written"):
        results.write(tmp_path / "folder", "--volumes", [b"x"])
    with pytest.raises(KeyboardInterrupt):
        results.write(tmp_path / "folder/link", "-o", broken())
    assert (tmp_path / "file").read_text() == "before"
    results.write(tmp_path / "folder/link", "-o", [b"aft", b"er"])
    assert (tmp_path / "file").read_text() == "after" and (tmp_path / "file").stat().st_mode & 0o777 == 0o640
    assert (tmp_path / "folder/link").is_symlink() and len(list(tmp_path.rglob("*"))) == 3


def test_a_task_that_leaves_nothing_to_check_fails_its_own_job_and_no_other(tmp_path, here_or_there):
    task, nothing = TOOLS / "reach.json", tmp_path / "nothing.json"
    nothing.write_text(json.dumps({**json.loads(task.read_text()), "collisions": {"self": False}}))
    message = batch("postures", ARM, nothing, task, *here_or_there, "-o", tmp_path / "out", status=1)
    assert f"{nothing}: no pair of bodies is checked" in message
    records = {record["job"][0]: record for record in map(json.loads, (tmp_path / "out").read_text().splitlines()[1:])}
    assert records[str(task)]["feasible"] and "error" in records[str(nothing)] and len(records) == 2
    assert str(ARM) not in message and "robot.urdf" not in message  # whose path differs where the job is done elsewhere


def slide(kind, axis="1 0 0"):
    """A ball on a joint, 1 m above its base."""
    ball = '<collision><geometry><sphere radius="0.05"/></geometry></collision>'
    return (f'<robot name="r"><link name="base">{ball}</link><link name="slider">{ball}</link><joint name="s" type="{kind}"><parent link="base"/>'
            f'<child link="slider"/><origin xyz="0 0 1"/><axis xyz="{axis}"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint></robot>')


def test_starts_of_a_joint_without_limits_are_numbers(tmp_path):
    robot, scene, task = (tmp_path / name for name in ("robot.urdf", "scene.urdf", "task.json"))
    robot.write_text(slide("planar", "0 0 1"))
    scene.write_text(slide("fixed").replace("0 0 1", "0 0 9"))
    two = [{"name": str(y), "link": "slider", "target": {"position": [0, y, 1]}, "free": ["rx", "ry", "rz"]} for y in (2, 2.5)]
    task.write_text(json.dumps({"base": "fixed", "placements": two, "collisions": {"pairs": [{"links": ["slider"]}]}}))
    batch("postures", robot, task, "--obstacles", scene, "--starts", 4, "--jobs", 1, "-o", tmp_path / "out")
    records = [json.loads(line) for line in (tmp_path / "out").read_text().splitlines()[1:]]
    assert len(records) == 4 and not any("error" in record for record in records)
    assert all(sum(amount for _, amount in record["violations"]) < 0.51 for record in records)
    search = fcl_stpbv.PostureSearch(str(robot), obstacles=str(scene))
    for start in (99999, 100000, 2**31 - 1):
        assert np.isfinite(search.solve(task.read_text(), start=start)["q"]).all()
    with pytest.raises(fcl_stpbv.Error, match="^task: start 0: leads to numbers that are not finite"):
        search.solve(task.read_text(), start_from=np.full(3, 1e300))


def test_a_grid_moves_a_base_that_is_fixed(tmp_path):
    robot, scene, task, grid = (tmp_path / name for name in ("robot.urdf", "scene.urdf", "task.json", "grid.json"))
    robot.write_text(slide("prismatic"))
    scene.write_text(slide("fixed"))  # balls at 0 and 1 m
    placement = {"name": "hand", "link": "slider", "target": {"position": [0.25, 0, 1.5]}, "free": ["rx", "ry", "rz"]}
    task.write_text(json.dumps({"base": "fixed", "placements": [placement]}))
    grid.write_text(json.dumps({"axes": [{"name": "up", "move": {"hand": [0, 0, 0]}, "base": [0, 0, 1], "from": 0, "to": 1, "count": 5}]}))
    batch("postures", robot, task, "--obstacles", scene, "--grid", grid, "--jobs", 1, "-o", tmp_path / "out")
    places = json.loads((tmp_path / "out").read_text().splitlines()[1])["places"]
    assert [place["feasible"] for place in places] == [False, False, True, False, False]  # 1.5 m can only be reached from 0.5 m
    assert abs(places[2]["q"][0] - 0.25) < 1e-5
    assert [any(name == "base - base" for name, _ in place["conflict"]) for place in places] == [True, False, False, False, False]
    task.write_text(json.dumps({"base": "floating", "start": {"joints": {"base/z": 1}}, "placements": [placement]}))
    assert "start.joints holds at its base/z" in batch("postures", robot, task, "--obstacles", scene, "--grid", grid, "-o", tmp_path / "no",
                                                       status=2)


def test_a_robot_with_a_bad_mesh_is_refused_before_any_job(tmp_path):
    (tmp_path / "bad.stl").write_bytes(b"solid nothing")
    ball = '<collision><geometry><sphere radius="0.1"/></geometry></collision>'
    urdf = tmp_path / "bad.urdf"
    urdf.write_text(f"""<robot name="bad"><link name="a">{ball}</link><link name="b">{ball}</link>
        <link name="c"><collision><geometry><mesh filename="bad.stl"/></geometry></collision></link>""" + "".join(
        f"""<joint name="{child}" type="revolute"><parent link="{parent}"/><child link="{child}"/><origin xyz="0.5 0 0"/><axis xyz="0 0 1"/>
        <limit lower="-1" upper="1" effort="1" velocity="1"/></joint>""" for parent, child in (("a", "b"), ("b", "c"))) + "</robot>")
    for arguments in (["prove", urdf], ["sample", urdf], ["postures", urdf, TOOLS / "reach.json"], ["prove", ARM, "--obstacles", urdf],
                      ["postures", ARM, TOOLS / "reach.json", "--obstacles", urdf]):
        message = batch(*arguments, "-o", tmp_path / "out", status=2)
        assert "bad.stl" in message and "Traceback" not in message and not (tmp_path / "out").exists()


def test_wrong_input_is_refused_in_one_line(proofs, tmp_path):
    out = tmp_path / "out"
    for arguments, what in [
            (["prove", tmp_path / "no.urdf", "-o", out], "no.urdf"),
            (["postures", ARM, tmp_path / "no.json", "-o", out], "no.json"),
            (["postures", ARM, ARM, "-o", out], "six_joint_arm.urdf"),
            (["convert", "a/x.stl", "b/x.stl", "--volumes", tmp_path / "v", "-o", out], "b/x.stl"),
            ([*PROVE, "--margin", "0.1", "--jobs", 1, "-o", proofs], "margin"),
            ([*PROVE, "--merge", tmp_path / "no.jsonl", "-o", out], "no.jsonl"),
            ([*PROVE, "--merge", ARM, "-o", out], "does not hold results"),
            ([*PROVE, "-o", tmp_path / "no/out", "--jobs", 1], "no/out"),
            ([*PROVE, "--shard", "0/2", "--scheduler", "tcp://x", "-o", out], "--shard"),
    ]:
        message = batch(*arguments, status=2)
        assert what in message and message.count("\n") == 1, message
        assert not out.exists()
    for arguments in (["--shard", "2/2"], ["--budget", "0"], ["--seed", "1e99"], ["-r", "nan"], ["-R", "-1"]):
        assert f"{arguments[0]}" in batch(*PROVE, *arguments, "-o", out, status=2).splitlines()[-1]


def test_an_empty_value_is_refused_and_not_taken_for_none(tmp_path):
    more = ["-o", tmp_path / "out", "--jobs", 1]
    for arguments in (["prove", ARM, "--obstacles", ""], ["prove", ARM, "--srdf", ""], ["prove", ARM, "--write-srdf", ""],
                      ["prove", ARM, "--package-path", ""], ["sample", ARM, "--obstacles", ""], ["sample", ARM, "--scheduler", ""],
                      ["sample", ARM, "--merge", ""], ["postures", ARM, TOOLS / "reach.json", "--grid", ""],
                      ["postures", ARM, TOOLS / "reach.json", "--srdf", ""], ["postures", ARM, TOOLS / "reach.json", "--obstacles", ""],
                      ["convert", ARM, "--volumes", ""]):
        assert f"argument {arguments[-2]}: the value is empty" in batch(*arguments, *more, status=2)
    for place in (["sample", ""], ["postures", str(ARM), ""], ["convert", "", "--volumes", str(tmp_path / "v")]):
        assert "the value is empty" in batch(*place, *more, status=2)
    assert "-o/--output: the value is empty" in batch("sample", ARM, "-o", "", status=2)
    assert not list(tmp_path.iterdir())


def test_no_output_replaces_an_input_or_another_output(tmp_path):
    robot, mesh, task, users, scene = (tmp_path / name for name in ("r.urdf", "meshes/part.stl", "task.json", "users.srdf", "scene.urdf"))
    mesh.parent.mkdir()
    shutil.copy(HRP2 / "meshes/LARM_LINK0.stl", mesh)
    robot.write_text(ARM.read_text().replace("</robot>", """<link name="part">
        <collision><geometry><mesh filename="meshes/part.stl"/></geometry></collision></link>
        <joint name="to_part" type="fixed"><parent link="flange"/><child link="part"/></joint></robot>"""))
    task.write_text((TOOLS / "reach.json").read_text())
    users.write_text('<robot name="six_joint_arm"/>')
    shutil.copy(ARM, scene)
    (tmp_path / "soft").symlink_to("r.urdf")
    os.link(robot, tmp_path / "hard")
    cube(tmp_path / "meshes/c.gltf", "sub/c.bin")
    (tmp_path / "meshes/empty.stl").touch()
    shutil.copy(mesh, tmp_path / "meshes/named.stpbv")
    batch("sample", robot, "--blocks", 1, "--count", 1, "--jobs", 1, "-o", tmp_path / "part_0")
    prove, out, convert = ["prove", robot, "--jobs", 1], tmp_path / "out", ["convert", "--volumes", tmp_path / "meshes"]
    before = {path: path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()}
    for arguments, what in [
            ([*prove, "-o", out, "--write-srdf", robot], "--write-srdf"),
            ([*prove, "-o", out, "--write-srdf", tmp_path / "meshes/../soft"], "--write-srdf"),
            ([*prove, "-o", out, "--write-srdf", tmp_path / "hard"], "--write-srdf"),
            ([*prove, "-o", out, "--write-srdf", mesh], "--write-srdf"),
            ([*prove, "-o", out, "--write-srdf", users, "--srdf", users], "--write-srdf"),
            ([*prove, "-o", out, "--write-srdf", scene, "--obstacles", scene], "--write-srdf"),
            ([*prove, "-o", out, "--merge", tmp_path / "part_0", "--write-srdf", tmp_path / "part_0"], "--write-srdf"),
            ([*prove, "-o", tmp_path / "soft"], "-o"),
            (["postures", robot, task, "-o", task], "-o"),
            (["postures", robot, task, "--grid", users, "-o", users], "-o"),
            ([*convert, tmp_path / "meshes/empty.stl", "-o", tmp_path / "meshes/empty.stl"], "-o"),
            ([*convert, tmp_path / "meshes/c.gltf", "-o", tmp_path / "meshes/sub/c.bin"], "-o"),
            ([*convert, tmp_path / "meshes/named.stpbv", "-o", out], "--volumes"),
    ]:
        message = batch(*arguments, status=2)
        assert f"{what} {tmp_path}" in message and "is an input, and writing would replace it; give" in message and message.count("\n") == 1, message
    for arguments, what in [([*prove, "-o", out, "--write-srdf", tmp_path / "meshes/../out"], "is the same file as -o"),
                            ([*convert, mesh, "-o", tmp_path / "meshes/part.stpbv"], "is the same file as -o"),
                            ([*prove, "-o", out, "--write-srdf", tmp_path / "no/a.srdf"], f"the folder {tmp_path}/no does not exist"),
                            ([*prove, "-o", out, "--write-srdf", tmp_path], "is a folder, a pipe or a device"),
                            ([*prove, "-o", "-"], "-o -: a run goes on from its files"),
                            ([*prove, "-o", out, "--write-srdf", "-"], "--write-srdf -: a run goes on from its files")]:
        message = batch(*arguments, status=2)
        assert what in message and message.count("\n") == 1, message
    assert before == {path: path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()}
    os.mkfifo(tmp_path / "pipe")
    for arguments in (["-o", tmp_path / "pipe"], ["-o", out, "--write-srdf", tmp_path / "pipe"]):
        assert "is a folder, a pipe or a device" in batch(*prove, *arguments, status=2) and (tmp_path / "pipe").is_fifo() and not out.exists()
    batch("sample", robot, "--blocks", 1, "--count", 1, "--merge", tmp_path / "part_0", "-o", tmp_path / "part_0")  # this is allowed
    assert (tmp_path / "part_0").read_bytes() == before[tmp_path / "part_0"]


def test_a_damaged_result_is_named_by_its_line(proofs, tmp_path):
    from fcl_stpbv.batch.__main__ import described, run

    sample = ["sample", ARM, "--blocks", 2, "--count", 3]
    postures = ["postures", ARM, TOOLS / "reach.json", "--starts", 1]
    (tmp_path / "grid.json").write_text(json.dumps({"axes": [{"name": "x", "move": {"tool": [1, 0, 0]}, "from": 0, "to": 0.1, "count": 2}]}))
    grid = [*postures, "--grid", tmp_path / "grid.json"]
    convert = ["convert", HRP2 / "meshes/LARM_LINK0.stl", "--volumes", tmp_path / "volumes"]
    good, bad = tmp_path / "good", tmp_path / "bad"
    fifteen = [0] * 15
    for command, changes in [
            (sample, [{"job": [0]}, {"job": ["x"]}, {"job": [True]}, {"job": [[0]]}, {"job": 0}, [], 5, {"collisions": [0]}, {"least": ["x"] * 15},
                      {"job": [0], "error": 5}, {"job": [0], "collisions": fifteen, "least": [float("nan")] * 15},
                      {"job": [0], "collisions": fifteen, "least": [10**400] * 15}, "[" * 200000, '{"job":[0],"collisions":' + "[" * 200000, "", "{",
                      b"\xff"]),
            (PROVE, [{"boxes": None}, {"boxes": 1.5}, {"boxes": 10**30}, {"open": 5}, {"open": {}}, {"open": [[[0], [1]]]}, {"open": [[]]},
                     {"collision": [0]}, {"unlimited": False}, {"job": ["base", "nothing", 0, 0]}, {"job": ["base", "upper_arm", 0, 0]}]),
            (postures, [{"feasible": None}, {"job": [0, 0]}]),
            (grid, [{"places": []}, {"places": [{}, {}]}, {"places": 5}]),
            (convert, [{"volume": "../out"}, {"volume": 5}, {"sha256": None}]),
    ]:
        if command is PROVE:
            shutil.copy(proofs, good)
        else:
            batch(*command, "--jobs", 1, "-o", good)
        lines = good.read_bytes().splitlines(keepends=True)
        for change in changes:
            if isinstance(change, dict) and "job" not in change:
                change = {**json.loads(lines[1]), **change}
            text = change if isinstance(change, bytes) else (change if isinstance(change, str) else json.dumps(change)).encode()
            bad.write_bytes(lines[0] + text + b"\n" + b"".join(lines[2:]))
            with pytest.raises(fcl_stpbv.Error, match=f"^{bad}:2: is damaged[^\n]*$"):
                run(described().parse_args([*map(str, command), "--merge", str(bad), "-o", str(tmp_path / "out")]))
            assert not (tmp_path / "out").exists()
        damaged = bad.read_bytes()
        message = batch(*command, "--jobs", 1, "-o", bad, status=2)
        assert f"{bad}:2: is damaged" in message and message.count("\n") == 1 and bad.read_bytes() == damaged
        bad.write_bytes(b"".join(lines[:1] + lines[2:]))  # the change that the message recommends
        batch(*command, "--jobs", 1, "-o", bad)
        assert bad.read_bytes() == good.read_bytes()
        good.unlink()
    bad.write_text("[" * 200000 + "\n")
    assert f"{bad}: does not hold results" in batch(*sample, "--merge", bad, "-o", tmp_path / "out", status=2)


def test_names_and_texts_of_any_bytes_are_taken_or_refused(tmp_path):
    task = pathlib.Path(os.fsdecode(os.fsencode(tmp_path) + b"/t\xff.json"))  # not UTF-8
    task.write_bytes(b"\xef\xbb\xbf" + (TOOLS / "reach.json").read_bytes())  # with the byte-order mark that some editors write
    batch("postures", ARM, task, "--starts", 1, "--jobs", 1, "-o", tmp_path / "out")
    grid = tmp_path / "grid.json"
    grid.write_text(json.dumps({"axes": [{"name": "x", "move": {"tool": [1, 0, 0]}, "from": 0, "to": 0.1, "count": 2}]}))
    batch("postures", ARM, task, "--grid", grid, "--starts", 1, "--jobs", 1, "-o", tmp_path / "places")
    grid.write_text("[" * 200000)
    assert "grid.json: is no JSON" in batch("postures", ARM, task, "--grid", grid, "-o", tmp_path / "no", status=2)
    assert r"no\udcff.urdf: no such file" in batch("sample", os.fsdecode(b"no\xff.urdf"), "-o", tmp_path / "no", status=2)
    away = pathlib.Path(os.fsdecode(os.fsencode(tmp_path) + b"/\xff"))
    shutil.copytree(HRP2, away)
    assert "hrp2_style.urdf: the path of one of its meshes is not UTF-8" in batch("sample", away / "hrp2_style.urdf", "-o", tmp_path / "no", status=2)
    os.mkfifo(tmp_path / "pipe")
    prove = [*PROVE, "--srdf", tmp_path / "pipe", "--write-srdf", tmp_path / "new"]
    assert "pipe: is a folder, a pipe" in batch(*prove, "-o", tmp_path / "no", status=2)


def test_a_summary_that_cannot_be_printed_costs_no_result(tmp_path):
    sample = [sys.executable, "-B", "-m", "fcl_stpbv.batch", "sample", ARM, "--blocks", "1", "--count", "1", "--jobs", "1", "-o", tmp_path / "out"]
    with open("/dev/full", "w") as full:
        done = subprocess.run(sample, stdout=full, stderr=subprocess.PIPE, text=True, timeout=120)
    assert done.returncode == 2 and done.stderr.startswith("fcl_stpbv.batch: standard output: cannot be written") and done.stderr.count("\n") == 1
    assert len((tmp_path / "out").read_text().splitlines()) == 2


@pytest.mark.parametrize("unbuffered", [[], ["-u"]])
@pytest.mark.parametrize("option", ["--help", "--version"])
def test_help_that_cannot_be_printed_is_told_in_one_line(option, unbuffered):
    with open("/dev/full", "w") as full:
        done = subprocess.run([sys.executable, "-B", *unbuffered, "-m", "fcl_stpbv.batch", option], stdout=full, stderr=subprocess.PIPE, text=True,
                              timeout=120)
    assert done.returncode == 2 and done.stderr == "fcl_stpbv.batch: standard output: cannot be written: No space left on device\n"


def test_without_dask_one_process_works_and_more_say_what_is_missing(tmp_path):
    (tmp_path / "dask.py").write_text("raise ImportError")
    without = {**os.environ, "PYTHONPATH": f"{tmp_path}:{os.environ['PYTHONPATH']}"}
    sample = ["sample", ARM, "--blocks", 2, "--count", 5, "-o", tmp_path / "out"]
    assert "python3-distributed" in batch(*sample, "--jobs", 2, status=2, start=cold_start, env=without)
    batch(*sample, "--jobs", 1, start=cold_start, env=without)
