# SPDX-License-Identifier: MIT
"""Prints glint/_options.py: the engine's options as Python source, from include/glint/options.inc.

A row becomes a key of the class Options, which types keyword arguments, and its default an entry of DEFAULTS."""
import os
import pathlib
import re
import shlex
import subprocess
import textwrap

INCLUDE = pathlib.Path(__file__).resolve().parents[3] / "include"
# Rows as tuples of Python: their strings are literals of both languages.
MACROS = """
#define NUMBER(type, member, name, value, low, high, initial, unit, group, scope, changes, help) \\
    (#member, name, #type, initial, unit, #scope, help),
#define GLINT_ROW_REAL(...) NUMBER(float, __VA_ARGS__)
#define GLINT_ROW_INTEGER(...) NUMBER(int, __VA_ARGS__)
#define GLINT_ROW_FLAG(member, name, group, scope, changes, help) (#member, name, "bool", False, "", #scope, help),
#define GLINT_ROW_WORD(member, name, value, words, initial, group, scope, changes, help) \\
    (#member, name, "Literal", None if initial == None else words.split("|")[initial], words, #scope, help),
#define GLINT_ROW_TEXT(member, name, value, initial, accepts, group, scope, changes, help) \\
    (#member, name, "str", initial or None, "", #scope, help),
#include "glint/options.inc"
"""
TABLE = ["coating"]  # of the options of lens tables
OWN = ["lens", "stop", "exposure"]  # parameters of Engine with other types or defaults


def rows():
    """Returns (member, name, type, default, words or unit, scope, help) of each option."""
    command = [*shlex.split(os.environ.get("CC", "cc")), "-E", "-P", "-x", "c", "-I", str(INCLUDE), "-"]
    text = subprocess.run(command, input=MACROS, check=True, stdout=subprocess.PIPE, text=True).stdout
    return eval(f"[{text}]", {"NAN": None})  # constants of this tree


def hint(kind, accepts, default):
    """Returns the type of an argument."""
    if kind == "Literal":
        kind = "Literal[" + ", ".join(f'"{word}"' for word in accepts.split("|")) + "]"
    if kind == "float" and re.search("(^|, )or [a-z]", accepts):  # a word that stands for a number
        kind = "Union[float, str]"
    return f"Optional[{kind}]" if default is None else kind


def source():
    keys, defaults = [], []
    for member, name, kind, default, accepts, scope, text in rows():
        assert member.replace("_", "-") == name, name
        if (scope != "PICTURE" and member not in TABLE) or member in OWN:
            continue
        keys += textwrap.wrap(text, 110, initial_indent="    # ", subsequent_indent="    # ")
        keys.append(f"    {member}: {hint(kind, accepts, default)}")
        defaults.append(f'    "{member}": {default!r},')
    return "\n".join([
        '"""The options of the engine. Made from include/glint/options.inc."""',
        "from __future__ import annotations", "",
        "from typing import Any, Dict, Literal, Optional, TypedDict, Union", "", "",
        "class Options(TypedDict, total=False):", *keys, "", "",
        "DEFAULTS: Dict[str, Any] = {", *defaults, "}", ""])


if __name__ == "__main__":
    print(source(), end="")
