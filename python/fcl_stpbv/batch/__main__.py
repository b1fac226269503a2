"""python -m fcl_stpbv.batch prove|sample|postures|convert: many jobs on all cores, a Dask cluster or a job array."""
import argparse
import math
import os
import re
import sys
import warnings

import fcl_stpbv
from fcl_stpbv.batch import engine, places, results
from fcl_stpbv.batch.bundle import digest_of
from fcl_stpbv.batch.kinds import KINDS

FOOTER = """Exit status: 0 all jobs are done; 1 some failed or are missing, the others are in the file; 2 the command line or an input is
wrong, or Dask is missing or cannot start its processes; 130 interrupted. A run that ended early goes on where it was when it is started again."""


def number(kind, least, most, unit="", word=None):
    """Returns a parser for argparse that accepts finite numbers from `least` to `most`, both included, and the word if one is given."""
    def read(text):
        if word and text == word:
            return word
        try:
            value = kind(text)
        except ValueError:
            value = math.nan
        if not least <= value <= most:
            what = "a whole number" if kind is int else "a number"
            raise argparse.ArgumentTypeError(f"got {text}, expected {what} from {least} to {most}{unit}" + (f" or '{word}'" if word else ""))
        return value
    return read


def given(text):
    """Parser for argparse: the name of a file or a folder, or an address; not empty."""
    if not text:
        raise argparse.ArgumentTypeError("the value is empty, as from a shell variable that is not set; give one, or leave the option out")
    return text


def share(text):
    found = re.fullmatch(r"(\d+)/(\d+)", text)
    if not found or int(found[1]) >= int(found[2]):
        raise argparse.ArgumentTypeError(f"got {text}, expected I/N with I from 0 to N - 1, such as 0/4")
    return int(found[1]), int(found[2])


LENGTH, MARGIN, SCALE = number(float, 0, 1e6, " m", "auto"), number(float, -1e6, 1e6, " m"), number(float, 1e-9, 1e9)
COUNT, WHOLE = number(int, 1, 2**31 - 1), number(int, 0, 2**31 - 1)  # what an int holds in C++


def radii(parser, body):
    parser.add_argument("-r", type=LENGTH, default=0.01, help=f"radius of the small spheres, the margin (m); 'auto' fits each {body} [0.01]")
    parser.add_argument("-R", type=LENGTH, help=f"radius of the big spheres (m); 'auto' fits each {body} [10, or auto where r is]")


def described():
    common = argparse.ArgumentParser(add_help=False)
    common.add_argument("-o", "--output", type=given, required=True, metavar="FILE", help="results as JSON lines; a run goes on from those it holds")
    common.add_argument("--scheduler", type=given, metavar="ADDRESS", help="of a Dask cluster, such as tcp://host:8786, instead of this machine")
    common.add_argument("--jobs", type=COUNT, default=engine.cores(), help="processes on this machine [all cores]")
    common.add_argument("--shard", type=share, metavar="I/N", help="do only part I of N, in this process")
    common.add_argument("--merge", type=given, nargs="+", metavar="FILE", default=[],
                        help="begin with the results in these files; without --shard nothing is computed")
    common.add_argument("-q", "--quiet", action="store_true", help="no progress, no warnings and no summary")
    robot = argparse.ArgumentParser(add_help=False)
    robot.add_argument("robot", type=given, metavar="ROBOT", help="its URDF")
    robot.add_argument("--package-path", type=given, action="append", default=[], metavar="FOLDER", help="holds packages; may be given again")
    radii(robot, "link")
    robot.add_argument("--seed", type=WHOLE, default=1, help="of the random numbers [1]")
    pairs = argparse.ArgumentParser(add_help=False)
    pairs.add_argument("--obstacles", type=given, metavar="FILE", help="URDF of a scene: each moving link and obstacle is a pair too")
    pairs.add_argument("--margin", type=MARGIN, default=0.0, help="a distance not above it is a collision (m) [0]")

    parser = argparse.ArgumentParser(prog="python -m fcl_stpbv.batch", description=__doc__, epilog=FOOTER)
    parser.add_argument("--version", action="version", version=f"fcl_stpbv {fcl_stpbv.__version__}")
    kinds = parser.add_subparsers(dest="kind", required=True, metavar="prove|sample|postures|convert")
    prove = kinds.add_parser("prove", parents=[robot, pairs, common], help="that pairs of links never meet")
    prove.add_argument("--boxes", type=COUNT, default=100000, help="for a pair, about; more continues a run [100000]")
    prove.add_argument("--budget", type=COUNT, default=10000, help="boxes a job [10000]")
    prove.add_argument("--descents", type=WHOLE, default=500, help="for a pair, before its proof [500]")
    prove.add_argument("--write-srdf", type=given, metavar="FILE", help="an SRDF whose every Never is proven")
    prove.add_argument("--srdf", type=given, metavar="FILE", help="that it begins with: all is kept but pairs of other reasons than User")
    sample = kinds.add_parser("sample", parents=[robot, pairs, common], help="distances of all pairs in random configurations")
    sample.add_argument("--blocks", type=COUNT, default=100, help="of configurations; more continues a run [100]")
    sample.add_argument("--count", type=COUNT, default=1000, help="configurations a block [1000]")
    postures = kinds.add_parser("postures", parents=[robot, common], help="for tasks, as find_posture --primitives flat does")
    postures.add_argument("tasks", type=given, nargs="+", metavar="TASK", help="its JSON file (docs/posture.md)")
    postures.add_argument("--srdf", type=given, metavar="FILE", help="pairs to leave out and postures")
    postures.add_argument("--obstacles", type=given, metavar="FILE", help="URDF of a scene to keep clear of")
    postures.add_argument("--starts", type=COUNT, default=5, help="at most, for a task; more continues a run, but for a grid's [5]")
    postures.add_argument("--grid", type=given, metavar="FILE", help="moves the task's targets; a job is then a row of this grid")
    postures.add_argument("--independent", action="store_true", help="each place of a grid from the task's starts alone, not from its neighbours' postures")
    convert = kinds.add_parser("convert", parents=[common], help="meshes to volumes")
    convert.add_argument("meshes", type=given, nargs="+", metavar="MESH")
    convert.add_argument("--volumes", type=given, required=True, metavar="FOLDER", help="where MESH.stpbv goes, replacing nothing; made if missing")
    radii(convert, "mesh")
    convert.add_argument("--scale", type=SCALE, default=1.0, help="factor on the coordinates, 0.001 for millimetres [1]")
    return parser


def compute(arguments, schedule, show):
    if arguments.shard or (arguments.jobs == 1 and not arguments.scheduler):
        engine.run_here(schedule, show)
    elif schedule.ready:
        with engine.connected(arguments.scheduler, arguments.jobs) as client:
            engine.run_on(client, schedule, show)


def unwritten(error, more=""):
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)  # receives the output that is still buffered
    return fcl_stpbv.Error(f"standard output: cannot be written: {error.strerror}{more}")


def say(text):
    try:
        print(text, flush=True)
    except OSError as error:
        raise unwritten(error, "; the results are in their file, -q leaves this out") from None


def asked():
    try:
        try:
            return described().parse_args()
        finally:
            sys.stdout.flush()  # for the output of --help and --version
    except OSError as error:
        raise unwritten(error) from None


def loaded(kind, arguments):
    """Makes the batch of this kind; prints the warnings of loading its files."""
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always", UserWarning)
        batch = KINDS[kind](arguments)
    for warning in told if not arguments.quiet else []:
        print(f"fcl_stpbv.batch: {warning.message}", file=sys.stderr)
    return batch


def run(arguments):
    if arguments.R is None:
        arguments.R = "auto" if arguments.r == "auto" else 10.0
    if arguments.shard and arguments.scheduler:
        raise fcl_stpbv.Error("--shard: is done in this process; leave out --scheduler")
    grid = arguments.kind == "postures" and arguments.grid
    if arguments.kind == "postures" and arguments.independent and not grid:
        raise fcl_stpbv.Error("--independent: is about the places of a grid; give --grid")
    places.check(arguments)
    try:
        kind = loaded("grid" if grid else arguments.kind, arguments)
    except UnicodeDecodeError:  # UnicodeDecodeError: names of links and joints, which Python reads as UTF-8
        raise fcl_stpbv.Error(f"{arguments.robot}: a name in it or in its obstacles is not UTF-8; save the files in UTF-8") from None
    header = {"batch": kind.name, "version": fcl_stpbv.__version__, "bundle": digest_of(kind.files), **kind.options}
    jobs = results.merge(arguments.merge, header, kind)
    file = results.ResultFile(arguments.output, header, kind)
    for job in sorted(jobs.keys() - file.jobs.keys()):
        file.add(jobs[job])
    schedule = engine.Schedule(kind, file, arguments.shard or (0, 1))
    show, clear = engine.progress(arguments.quiet)
    try:
        if arguments.shard or not arguments.merge:
            compute(arguments, schedule, show)
    finally:
        clear()
        file.close(sort=not schedule.ready and not +schedule.running)
    if arguments.kind == "prove" and arguments.write_srdf:
        kind.write_srdf(arguments.write_srdf, file.jobs)
    for record in file.jobs.values():
        if "error" in record:
            print(f"fcl_stpbv.batch: {record['error']}", file=sys.stderr)
    if not arguments.quiet:
        say(kind.summary(file.jobs))
    if schedule.ready:
        print(f"fcl_stpbv.batch: {len(schedule.ready)} jobs are missing; run without --merge to do them", file=sys.stderr)
    return 1 if schedule.ready or any("error" in record for record in file.jobs.values()) else 0


def open_streams():
    """Opens /dev/null for standard streams that are closed, so that no file of results gets their file descriptors. Writing to a standard
    output that was closed fails, as it should."""
    for name, mode, access in (("stdin", "r", os.O_RDONLY), ("stdout", "w", os.O_RDONLY), ("stderr", "w", os.O_WRONLY)):
        if getattr(sys, name) is None:
            setattr(sys, name, open(os.open(os.devnull, access), mode))


def main():
    open_streams()
    try:
        return run(asked())
    except fcl_stpbv.Error as error:
        print(f"fcl_stpbv.batch: {error}", file=sys.stderr)
        return 2
    except engine.Stopped as stopped:
        print(f"fcl_stpbv.batch: {stopped}; run again to go on", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print("fcl_stpbv.batch: interrupted; run again to go on", file=sys.stderr)
        return 130


if __name__ == "__main__":
    sys.exit(main())
