// SPDX-License-Identifier: MIT
//
// web_page.js FOLDER - tests the web page in Debian's Chromium: drops a photograph, drags a lamp,
// chooses a lens, a style and a doubtful region. Each saved picture must equal that of the command
// that the page prints. FOLDER contains node_modules/playwright-core (npm install playwright-core). Needs
// make web, make oiio and chromium. The test takes minutes, so make check does not run it.
import {execFileSync, spawn} from "node:child_process";
import fs from "node:fs";
import {createRequire} from "node:module";
import os from "node:os";
import path from "node:path";

const {chromium} = createRequire(path.resolve(process.argv[2]) + "/")("playwright-core");
const root = path.resolve(import.meta.dirname, "../.."), port = 8713;
const work = fs.mkdtempSync(path.join(os.tmpdir(), "web-page-"));
const server = spawn("python3", ["-m", "http.server", "--bind", "127.0.0.1", "-d", root + "/build/web", port], {stdio: "ignore"});
const browser = await chromium.launch({executablePath: "/usr/bin/chromium", args: ["--no-sandbox"]});
const page = await browser.newPage({viewport: {width: 1280, height: 800}, acceptDownloads: true});
let failed = 0;
const check = (name, is) => {
    console.log((is ? "ok " : "not ok ") + name);
    failed += !is;
};
const status = () => page.textContent("#status");
const base64 = file => fs.readFileSync(file).toString("base64");

async function drop(name, data, type) {
    await page.evaluate(([name, data, type]) => {
        const moved = new DataTransfer();
        moved.items.add(new File([Uint8Array.from(atob(data), c => c.charCodeAt(0))], name, {type}));
        dispatchEvent(new DragEvent("drop", {dataTransfer: moved, cancelable: true}));
    }, [name, data, type]);
}

async function open(file) {
    fs.copyFileSync(root + "/" + file, work + "/photo.jpg");
    await drop("photo.jpg", base64(work + "/photo.jpg"), "image/jpeg");
    await page.waitForFunction(() => document.body.dataset.first, null, {timeout: 0});
}

// Saves the picture, runs the printed command, and compares.
async function compare(name) {
    const command = await page.inputValue("#command");
    const [download] = await Promise.all([page.waitForEvent("download", {timeout: 0}), page.click("#export")]);
    await download.saveAs(work + "/page.png");
    execFileSync("bash", ["-ec", command], {cwd: work, stdio: "ignore", env: {...process.env, PATH: root + "/build:" + process.env.PATH,
        GLINT_LENSES: root + "/lenses", GLINT_OIIO: root + "/build/glint-oiio.so"}});
    check(name, await page.evaluate(async files => {
        const [a, b] = await Promise.all(files.map(async data => {
            const blob = new Blob([Uint8Array.from(atob(data), c => c.charCodeAt(0))]);
            const bitmap = await createImageBitmap(blob, {colorSpaceConversion: "none"});
            const context = new OffscreenCanvas(bitmap.width, bitmap.height).getContext("2d");
            context.drawImage(bitmap, 0, 0);
            return context.getImageData(0, 0, bitmap.width, bitmap.height).data;
        }));
        return a.length === b.length && a.every((value, i) => value === b[i]);
    }, [base64(work + "/page.png"), base64(work + "/photo-glint.png")]));
}

try {
    const outside = [];
    page.on("request", request => /^(http:\/\/127\.0\.0\.1|blob:|data:)/.test(request.url()) || outside.push(request.url()));
    for (let i = 0; i < 100 && await page.goto(`http://127.0.0.1:${port}/`).then(() => false, () => true); i++)
        await new Promise(done => setTimeout(done, 100));
    await page.waitForFunction(() => document.body.dataset.loaded, null, {timeout: 0});
    await open("tests/data/bridge.jpg");
    await compare("lamps as they are found");

    const box = await page.locator(".lamp").first().boundingBox();
    await page.mouse.move(box.x + 15, box.y + 15);
    await page.mouse.down();
    await page.mouse.move(box.x + 90, box.y + 50, {steps: 5});
    await page.mouse.up();
    await page.locator(".lamp").first().focus();
    await page.keyboard.press("ArrowRight");
    await page.keyboard.press("+");
    await compare("a lamp that was dragged and moved by keys");
    await page.fill("#search", "westanar");
    await page.click('#lenses button[data-name="tele-westanar-135"]');
    await compare("another lens");
    await page.focus("#search");
    await page.fill("#search", "");
    await page.keyboard.press("Tab");
    await page.keyboard.press("ArrowUp");
    check("arrow keys choose lenses", await page.evaluate(() => document.activeElement.getAttribute("aria-checked") === "true" &&
        document.activeElement.dataset.name !== "tele-westanar-135"));
    await page.waitForFunction(() => document.activeElement.dataset.thumb, null, {timeout: 0});
    check("the list shows the photograph with each lens", true);
    await page.click('#styles button[data-name="toy"]');
    await compare("a style");
    await page.click("#ghost-box summary");
    await page.click('#ghosts button[aria-label^="Mute"]', {timeout: 0});
    await compare("a ghost left out");
    const [download] = await Promise.all([page.waitForEvent("download", {timeout: 0}), page.click("#export-jpeg")]);
    const saved = fs.readFileSync(await download.path()).toString("latin1");
    check("a JPEG file keeps the metadata of the photograph", saved.includes("Exif\0\0") && saved.includes("OLYMPUS"));
    await open("tests/gallery/window.jpg");
    await page.waitForFunction(() => document.querySelectorAll(".doubt").length === 3, null, {timeout: 0});
    await page.locator(".doubt").first().click();
    await compare("a doubtful region as a lamp");
    await page.setViewportSize({width: 360, height: 740});
    check("360 pixels are wide enough", await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth));
    for (const [name, data, type] of [["cut.jpg", base64(work + "/photo.jpg").slice(0, 400), "image/jpeg"], ["a.svg", btoa("<svg/>"), "image/svg+xml"],
        ["empty.png", "", "image/png"], ["text.txt", btoa("text"), "text/plain"]]) {
        await drop(name, data, type);
        await page.waitForFunction(name => document.querySelector("#status.bad")?.textContent.startsWith(name), name, {timeout: 0});
        check(`${name}: ${await status()}`, true);
    }
    check("no request leaves the computer", outside.length === 0);
} finally {
    await browser.close();
    server.kill();
    fs.rmSync(work, {recursive: true});
}
process.exitCode = failed ? 1 : 0;
