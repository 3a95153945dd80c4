// SPDX-License-Identifier: BSD-3-Clause
// Takes a picture of a replay page at a scan, with the vehicle chosen that is nearest straight ahead.
// usage: node shoot_page.mjs PAGE SCAN PICTURE [WIDTHxHEIGHT]
import { writeFile } from "node:fs/promises";
import { Browser } from "./browser.mjs";

const [page, scan, picture, size = "1280x800"] = process.argv.slice(2);
const browser = await Browser.start(...size.split("x").map(Number));
try {
  await browser.open(`file://${page}#scan=${scan}`);
  await browser.until("window.replay && (replay.ready || replay.failed)");
  const failed = await browser.value("replay.failed ?? null");
  if (failed !== null) throw new Error(failed);
  await browser.until("replay.drawn === replay.place");
  const id = await browser.value(`(() => {
    const vehicle = 1, ahead = replay.obstacles.filter((o) => o.cls === vehicle && o.x > 5 && Math.abs(o.y) < 1.5);
    ahead.sort((a, b) => a.distance - b.distance);
    return ahead.length > 0 ? ahead[0].id : null;
  })()`);
  if (id === null) throw new Error("no vehicle straight ahead in scan " + scan);
  await browser.value(`replay.setTheme("dark"); replay.pick(${id})`);
  await browser.until("!replay.dirty && replay.view.share === 1");
  await writeFile(picture, Buffer.from(await browser.screenshot(), "base64"));
  if (browser.errors.length > 0) throw new Error(browser.errors.join("\n"));
} finally {
  await browser.stop();
}
