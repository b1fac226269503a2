"""A kind of batch (kinds.py): postures for tasks, each from several starts."""
import fcl_stpbv
from fcl_stpbv.batch import bundle


def shown(name):
    """A name as a text, whatever bytes it contains."""
    return name.encode(errors="backslashreplace").decode()


class Postures:
    """Postures for tasks. A job is one start of one task; the next start is tried if the starts before found no posture."""
    name, key = "postures", [str, int]

    def __init__(self, arguments):
        path = arguments.package_path
        self.options = {key: getattr(arguments, key) for key in ("r", "R", "seed")}
        self.tasks = {task: bundle.read(task, pipe=True).decode("utf-8-sig", "replace") for task in arguments.tasks}
        self.options["tasks"] = bundle.digest_of({name: text.encode() for name, text in self.tasks.items()})
        self.context = fcl_stpbv.PostureSearch(arguments.robot, arguments.srdf, arguments.obstacles, r=arguments.r, R=arguments.R,
                                               package_path=path)
        for name, text in self.tasks.items():
            self.context.names(text, shown(name))  # reports a task that does not fit the robot before anything is computed
        self.files = bundle.robot_files("robot", arguments.robot, path)
        if arguments.srdf:
            self.files["robot/robot.srdf"] = bundle.read(arguments.srdf)
        if arguments.obstacles:
            self.files.update(bundle.robot_files("scene", arguments.obstacles, path))
        self.starts = arguments.starts
        self.groups = list(self.tasks)

    @staticmethod
    def open(folder, options):
        given = [str(folder / name) if (folder / name).exists() else None for name in ("robot/robot.srdf", "scene/robot.urdf")]
        return fcl_stpbv.PostureSearch(str(folder / "robot/robot.urdf"), *given, r=options["r"], R=options["R"])

    @staticmethod
    def run(search, options, job, text):
        return search.solve(text, shown(job[0]), job[1], options["seed"]), None

    def fits(self, job, record):
        return type(record["feasible"]) is bool

    def jobs(self, task, done):
        for start in range(self.starts):
            if (task, start) not in done:
                return [((task, start), self.tasks[task])]
            if done[task, start].get("feasible") or "error" in done[task, start]:
                break
        return []

    def summary(self, done):
        found = {record["job"][0] for record in done.values() if record.get("feasible")}
        return f"{len(self.groups)} tasks: {len(found)} with a posture, {len(self.groups) - len(found)} without; {len(done)} starts"
