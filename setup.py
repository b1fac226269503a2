"""The Python package as a wheel: `pip install .` builds the module with CMake, or takes it from the folder FCL_STPBV_BUILD,
a build with static libraries."""
import os
import pathlib
import re
import shutil
import subprocess
import sys

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

PROJECT = pathlib.Path(__file__).resolve().parent
CMAKE = (PROJECT / "CMakeLists.txt").read_text()


class CMakeBuild(build_ext):
    """Builds the module and puts it where setuptools looks for it."""

    def build_extension(self, extension):
        target = pathlib.Path(self.get_ext_fullpath(extension.name)).resolve()
        given = os.environ.get("FCL_STPBV_BUILD")
        build = pathlib.Path(given or self.build_temp).resolve()
        if not given:
            subprocess.run(["cmake", "-S", PROJECT, "-B", build, "-DCMAKE_BUILD_TYPE=Release", "-DBUILD_SHARED_LIBS=OFF",
                            "-DBUILD_TESTING=OFF", f"-DPython_EXECUTABLE={sys.executable}"], check=True)
            subprocess.run(["cmake", "--build", build, "--target", "fcl_stpbv_python", "--parallel", str(os.cpu_count())],
                           check=True)
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(build / "python/fcl_stpbv" / target.name, target)


setup(
    name="fcl_stpbv",
    version=re.search(r"project\(fcl_stpbv VERSION ([0-9.]+)", CMAKE)[1],
    description=re.search(r'DESCRIPTION "([^"]*)"', CMAKE)[1],
    license="BSD-2-Clause",
    python_requires=">=3.9",
    install_requires=["numpy"],
    ext_modules=[Extension("fcl_stpbv.__init__", sources=[])],  # the package is the extension itself
    cmdclass={"build_ext": CMakeBuild},
    packages=["fcl_stpbv", "fcl_stpbv.batch"],
    package_dir={"": "python"},
    package_data={"fcl_stpbv": ["__init__.pyi", "py.typed"]},
)
