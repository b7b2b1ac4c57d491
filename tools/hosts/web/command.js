// SPDX-License-Identifier: MIT
//
// command.js - the command line that gives the picture of the page: printed, and read.
import {COLUMNS, ghostFile, LAMP, lampFile} from "./glint.js";

// Options that are read although the table of the module does not list them.
const OTHERS = ["ghosts", "layer", "lights", "rays", "style"];
// What the names of saved pictures end with. The command of a JPEG file gives the picture before it is compressed.
export const ENDINGS = {png: "-glint.png", jpeg: "-glint.png", deep: "-glint16.png", layer: "-flare.png"};
const quote = text => /^[A-Za-z0-9_.,:\/=+@-]+$/.test(text) ? text : "'" + text.replaceAll("'", "'\\''") + "'";

// Returns the lines of a shell. MUTED: numbers of ghosts. LAMPS null: as they are found. FORMAT: of the file, as in index.html.
export function commandLine(name, values, muted, lamps, format = "png") {
    const lines = lamps ? ["cat >lamps.csv <<'END'\n" + lampFile(lamps) + "END"] : [];
    if (muted.length)
        lines.push("cat >ghosts.txt <<'END'\n" + ghostFile(muted) + "END");
    const path = name[0] === "-" ? "./" + name : name, base = path.replace(/\.[^.\/]*$/, "");
    const file = format === "deep" ? base + "-16.png" : path;
    if (format === "deep")
        lines.push(`convert ${quote(path)} -strip ${quote("PNG48:" + file)}`);
    const options = Object.entries(values).map(([key, value]) => value === "yes" ? "--" + key : `--${key} ${quote(String(value))}`);
    lines.push(["glint overlay", quote(file), "-o", quote(base + ENDINGS[format]), "--rays exact", ...options,
        ...format === "layer" ? ["--layer flare-alpha"] : [], ...lamps ? ["--lights lamps.csv"] : [], ...muted.length ? ["--ghosts ghosts.txt"] : []].join(" "));
    return lines.join("\n") + "\n";
}

function readLamps(text) {
    const [head, ...rows] = text.trim().split("\n").map(line => line.split(","));
    return rows.map(row => Object.fromEntries(COLUMNS.map(name => [name, Number(row[head.indexOf(name)] ?? LAMP[name])])));
}

// Returns {values, muted, lamps} of TEXT, lines as those of commandLine(). TABLES: of the module.
export function readCommand(text, {options, styles}) {
    const files = {}, state = {values: {}, muted: [], lamps: null};
    const rest = text.replace(/^convert .*\n/m, "").replaceAll(/cat >(\S+) <<'END'\n([^]*?)END\n/g, (all, name, lines) => {
        files[name] = lines;
        return "";
    });
    const words = (rest.replaceAll("\\\n", " ").match(/(?:'[^']*'|"[^"]*"|\\.|[^\s'"\\])+/g) ?? [])
        .map(word => word.replaceAll(/'([^']*)'|"([^"]*)"|\\(.)/g, "$1$2$3"));
    if (words[0] !== "glint" || words[1] !== "overlay")
        throw new Error("The command does not begin with glint overlay");
    for (let i = 2; i < words.length; i++) {
        const [, name, given] = /^--([a-z-]+)(?:=([^]*))?$/.exec(words[i]) ?? [], row = options.find(one => one.name === name);
        if (words[i] === "-o")
            i++;
        if (!name)
            continue;
        if (!row && !OTHERS.includes(name))
            throw new Error(`The page has no option --${name}`);
        const value = row?.type === "flag" ? "yes" : given ?? words[++i];
        if (name === "lights" || name === "ghosts") {
            if (!(value in files))
                throw new Error(`The file ${value} of --${name} is not in the command`);
            if (name === "lights")
                state.lamps = readLamps(files[value]);
            else
                state.muted = [...files[value].matchAll(/^(\d+) mute$/gm)].map(([, number]) => Number(number));
        } else if (name === "style")
            Object.assign(state.values, styles.find(style => style.name === value)?.set);
        else if (name !== "rays" && name !== "layer")
            state.values[name] = value;
    }
    return state;
}
