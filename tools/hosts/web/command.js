// SPDX-License-Identifier: MIT
//
// command.js - the command line that gives the picture of the page.
import {ghostFile, lampFile} from "./glint.js";

const quote = text => /^[A-Za-z0-9_.,:\/=+@-]+$/.test(text) ? text : "'" + text.replaceAll("'", "'\\''") + "'";

// Returns the lines of a shell. MUTED: numbers of ghosts. LAMPS null: as they are found.
export function commandLine(name, values, muted, lamps) {
    const lines = lamps ? ["cat >lamps.csv <<'END'\n" + lampFile(lamps) + "END"] : [];
    if (muted.length)
        lines.push("cat >ghosts.txt <<'END'\n" + ghostFile(muted) + "END");
    const file = name[0] === "-" ? "./" + name : name;
    const options = Object.entries(values).map(([key, value]) => value === "yes" ? "--" + key : `--${key} ${quote(String(value))}`);
    lines.push(["glint overlay", quote(file), "-o", quote(file.replace(/\.[^.\/]*$/, "") + "-glint.png"), "--rays exact",
        ...options, ...lamps ? ["--lights lamps.csv"] : [], ...muted.length ? ["--ghosts ghosts.txt"] : []].join(" "));
    return lines.join("\n") + "\n";
}
