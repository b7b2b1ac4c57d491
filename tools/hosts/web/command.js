// SPDX-License-Identifier: MIT
//
// command.js - the command line that gives the picture of the page: printed, and read.
import {COLUMNS, LAMP, lampFile} from "./glint.js";

// Options that are read although the table of the module does not list them.
const OTHERS = ["layer", "lights", "rays", "style"];
// What the names of saved pictures end with. The command of a JPEG file gives the picture before it is compressed.
export const ENDINGS = {png: "-glint.png", jpeg: "-glint.png", deep: "-glint16.png", layer: "-flare.png"};
const quote = text => /^[A-Za-z0-9_.,:\/=+@-]+$/.test(text) ? text : "'" + text.replaceAll("'", "'\\''") + "'";

// Returns the lines of a shell. LAMPS null: as they are found. FORMAT: of the file, as in index.html.
export function commandLine(name, {ghosts, ...values}, lamps, format = "png") {
    const lines = lamps ? ["cat >lamps.csv <<'END'\n" + lampFile(lamps) + "END"] : [];
    if (ghosts)
        lines.push("cat >ghosts.txt <<'END'\n" + ghosts + "END");
    const path = name[0] === "-" ? "./" + name : name, base = path.replace(/\.[^.\/]*$/, "");
    const file = format === "deep" ? base + "-16.png" : path;
    if (format === "deep")
        lines.push(`convert ${quote(path)} -strip ${quote("PNG48:" + file)}`);
    const options = Object.entries(values).map(([key, value]) => value === "yes" ? "--" + key : `--${key} ${quote(String(value))}`);
    lines.push(["glint overlay", quote(file), "-o", quote(base + ENDINGS[format]), "--rays exact", ...options,
        ...format === "layer" ? ["--layer flare-alpha"] : [], ...lamps ? ["--lights lamps.csv"] : [], ...ghosts ? ["--ghosts ghosts.txt"] : []].join(" "));
    return lines.join("\n") + "\n";
}

function readLamps(text) {
    const [head, ...rows] = text.trim().split("\n").map(line => line.split(","));
    return rows.map(row => Object.fromEntries(COLUMNS.map(name => [name, Number(row[head.indexOf(name)] ?? LAMP[name])])));
}

// Returns {values, lamps} of TEXT, lines as those of commandLine(). TABLES: of the module.
export function readCommand(text, {options, styles}) {
    const files = {}, state = {values: {}, lamps: null};
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
                state.values.ghosts = files[value];
        } else if (name === "style")
            Object.assign(state.values, styles.find(style => style.name === value)?.set);
        else if (name !== "rays" && name !== "layer")
            state.values[name] = value;
    }
    return state;
}

// The words that a file of ghosts gives GHOST, a number: {solo, mute, gain, tint}. TEXT: of the file.
export function readGhost(text, ghost) {
    const words = {};
    for (const line of text.split("\n")) {
        const [name, ...rest] = line.replace(/#.*/, "").trim().split(/\s+/);
        while (name === String(ghost) && rest.length) {
            const word = rest.shift();
            words[word] = word === "gain" || word === "tint" ? rest.shift() : true;
        }
    }
    return words;
}

// Returns TEXT with WORDS for GHOST.
export function writeGhost(text, ghost, words) {
    const others = text.split("\n").filter(line => line.trim() && line.trim().split(/[\s#]/)[0] !== String(ghost));
    const own = Object.entries(words).filter(([, value]) => value).map(([word, value]) => value === true ? word : word + " " + value);
    return [...others, ...own.length ? [[ghost, ...own].join(" ")] : []].map(line => line + "\n").join("");
}
