# SPDX-License-Identifier: MIT
"""Builds the package: glint's archives by its Makefile, then the module over them."""
import pathlib
import re
import shutil
import subprocess
import sys

import setuptools
from setuptools.command.build_py import build_py

HERE = pathlib.Path(__file__).resolve().parent
TREE = HERE.parents[2]


class Build(build_py):
    """Adds the options of the engine, and the lens tables."""

    def run(self):
        super().run()
        options = subprocess.run([sys.executable, str(HERE / "options.py")], check=True, stdout=subprocess.PIPE).stdout
        (pathlib.Path(self.build_lib) / "glint" / "_options.py").write_bytes(options)
        for table in sorted((TREE / "lenses").rglob("*.lens")):
            to = pathlib.Path(self.build_lib) / "glint" / table.relative_to(TREE)
            to.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(table, to)


version = re.search(r'define GLINT_VERSION "(.*)"', (TREE / "include/glint/glint.h").read_text())[1]
setuptools.setup(
    version=version,
    cffi_modules=["build_engine.py:ffi"],
    cmdclass={"build_py": Build},
)
