// SPDX-License-Identifier: BSD-3-Clause
// Opens a replay page in headless Chromium, plays it, clicks a box, and prints what it saw as JSON.
// usage: node play_page.mjs PAGE [SCREENSHOT_PREFIX [WIDTHxHEIGHT [SECONDS]]]
import { writeFile } from "node:fs/promises";
import { Browser } from "./browser.mjs";

const [page, prefix, size = "1280x800", seconds = "3"] = process.argv.slice(2);
const browser = await Browser.start(...size.split("x").map(Number));
const shoot = async (name) => {
  if (prefix) await writeFile(`${prefix}${name}.png`, Buffer.from(await browser.screenshot(), "base64"));
};
const seen = {};
try {
  const begin = Date.now();
  await browser.open("file://" + page);
  await browser.until("window.replay && (replay.ready || replay.failed)");
  seen.failed = await browser.value("replay.failed ?? null");
  seen.load_ms = Date.now() - begin;
  if (seen.failed === null) await look();
} finally {
  seen.errors = browser.errors;
  await browser.stop();
}
console.log(JSON.stringify(seen));

async function look() {
  seen.scans = await browser.value("replay.recording.frames.length");
  seen.note = await browser.value("by('note').textContent");
  if (seen.scans === 0) return;
  await browser.until("replay.drawn === replay.place");
  seen.kinds = await browser.value("Object.fromEntries(replay.recording.scanAt(0).counts.map((n, k) => [KINDS[k], n]))");
  seen.colors = await drawnColors();
  await shoot("_first");
  await play();
  await select();
  await steer();
}

/** How many colours there are in the picture: one means that nothing was drawn. */
function drawnColors() {
  return browser.value(`(() => {
    const gl = replay.view.gl, { width, height } = gl.canvas, bytes = new Uint8Array(4 * width * height);
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
    return new Set(new Uint32Array(bytes.buffer)).size;
  })()`);
}

/** At recording speed, by itself and then with a camera that never rests: every frame is drawn anew. */
async function play() {
  const state = () => browser.value("[performance.now(), replay.frames, replay.place]");
  await browser.key(" ", "Space");
  await browser.until("replay.place > 0", 20);
  await browser.value("window.turning = setInterval(() => { replay.view.camera.turn(1, 0); replay.dirty = true; }, 5)");
  await new Promise((resolve) => setTimeout(resolve, 1000));
  const before = await state();
  await new Promise((resolve) => setTimeout(resolve, 1000 * Number(seconds)));
  const after = await state();
  seen.frames_per_second = 1000 * (after[1] - before[1]) / (after[0] - before[0]);
  seen.played = after[2];
  seen.share = await browser.value("replay.view.share");
  seen.processor_ms_per_frame = { all: await weigh(1), fewest: await weigh(0.2) };
  await browser.value("delete replay.pace");
  await browser.value("clearInterval(turning); replay.play(false); replay.look('behind')");
}

/** What a frame with that share of the background's points costs, whoever else uses the processor. */
async function weigh(share) {
  await browser.value(`replay.pace = () => {}; replay.view.share = ${share}; replay.place > replay.recording.frames.length / 2 && replay.seek(0); replay.play(true)`);
  const state = async () => [await browser.processorSeconds(), await browser.value("replay.frames")];
  const before = await state();
  await new Promise((resolve) => setTimeout(resolve, 1000 * Number(seconds)));
  const after = await state();
  return 1000 * (after[0] - before[0]) / Math.max(1, after[1] - before[1]);
}

/** Clicks the middle of a box that lies free, where it is drawn. */
async function select() {
  await browser.key("Home");
  await browser.until("replay.drawn === 0");
  const place = await browser.value(`(() => {
    const { left, top, width, height } = by("scene").getBoundingClientRect();
    for (const o of [...replay.obstacles].sort((a, b) => a.distance - b.distance)) {
      if (![1, 2, 3].includes(o.cls) || o.x < 2) continue;
      const p = project(replay.view.camera.matrix(width / height), [o.x, o.y, o.z], width, height);
      if (p && p.x > 9 && p.y > 9 && p.x < width - 9 && p.y < height - 9 && replay.under(left + p.x, top + p.y) === o)
        return { id: o.id, x: left + p.x, y: top + p.y };
    }
    return null;
  })()`);
  seen.aimed = place;
  if (!place) return;
  await browser.click(place.x, place.y);
  await browser.until("!replay.dirty && replay.view.share === 1");
  seen.picked = await browser.value("replay.picked");
  seen.numbers = await browser.value("Object.fromEntries([...by('numbers').children].filter((e) => e.tagName === 'DT').map((e) => [e.textContent, e.nextElementSibling.textContent]))");
  seen.plots = await browser.value("by('plots').hidden ? 0 : [...document.querySelectorAll('.plot canvas')].filter((c) => new Set(new Uint32Array(c.getContext('2d').getImageData(0, 0, c.width, c.height).data.buffer)).size > 4).length");
  await shoot("_picked");
}

/** Themes, a turned camera, the slider, the list. */
async function steer() {
  const azimuth = await browser.value("replay.view.camera.azimuth");
  await browser.drag([400, 300], [500, 320]);
  seen.turned = (await browser.value("replay.view.camera.azimuth")) !== azimuth;
  seen.stillPicked = await browser.value("replay.picked");
  await browser.value("by('slider').value = replay.recording.frames.length - 1; by('slider').dispatchEvent(new Event('input'))");
  seen.slidTo = await browser.value("replay.recording.frames[replay.place].index");
  await browser.until("replay.drawn === replay.place");
  await browser.key("Escape");
  await browser.until("!replay.dirty");
  seen.left = await browser.value("replay.picked");
  seen.listed = await browser.value("by('obstacles').children.length");
  const theme = await browser.value("document.documentElement.dataset.theme");
  await browser.key("t");
  await browser.key("2");
  await browser.until("!replay.dirty && replay.view.share === 1");
  seen.themes = [theme, await browser.value("document.documentElement.dataset.theme")];
  await shoot("_other");
}
