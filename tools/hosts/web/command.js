// SPDX-License-Identifier: MIT
//
// command.js - the command line that gives the picture of the page.
import {lampFile} from "./glint.js";

// Lenses that open wider than this take minutes to hours to bake; the page bakes them for
// PAGE_STOP, as glint bake --f-number does.
const NARROW = 8;
const PAGE_STOP = 11;

// Returns the f-number that the model of LENS is baked for; 0: that of its table.
export function widestOf(lens, values) {
    if (lens.f >= NARROW)
        return 0;
    return Math.min(PAGE_STOP, Number(values["f-number"] ?? PAGE_STOP));
}

const quote = text => /^[A-Za-z0-9_.,:\/=+@-]+$/.test(text) ? text : "'" + text.replaceAll("'", "'\\''") + "'";

const words = (values, names) => names.flatMap(name => values[name] === undefined ? [] :
    values[name] === "yes" ? ["--" + name] : [`--${name} ${quote(String(values[name]))}`]);

// Returns the lines of a shell. LAMPS null: as they are found.
export function commandLine(name, values, lamps, widest) {
    const lines = [], ofModel = ["coating", "zoom", "focus"];
    let lens = values.lens;
    if (widest) {
        lens = `${values.lens}-${widest}.glint`;
        lines.push(["glint bake", values.lens, "--f-number", widest, ...words({coating: "mixed", ...values}, ofModel), "-o", lens].join(" "));
    }
    if (lamps)
        lines.push("cat >lamps.csv <<'END'\n" + lampFile(lamps) + "END");
    const names = Object.keys(values).filter(key => key !== "lens" && !(widest && ofModel.includes(key)));
    const stem = name.replace(/\.[^.]*$/, "");
    lines.push(["glint overlay", quote(name[0] === "-" ? "./" + name : name), "-o", quote((name[0] === "-" ? "./" : "") + stem + "-glint.png"),
        "--lens", lens, ...words(values, names), ...lamps ? ["--lights lamps.csv"] : []].join(" "));
    return lines.join("\n") + "\n";
}
