// SPDX-License-Identifier: BSD-3-Clause
// Drives a headless Chromium through its debugging pipe: no package needed.
import { spawn } from "node:child_process";
import { mkdtemp, readdir, readFile, rm } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";

export class Browser {
  /** Starts Chromium with software rendering and opens one page of this size. */
  static async start(width, height) {
    const browser = new Browser();
    browser.profile = await mkdtemp(join(tmpdir(), "lidar_obstacles_chromium_"));
    const flags = ["--headless=new", "--remote-debugging-pipe", "--no-sandbox", "--no-first-run", "--disable-extensions",
      "--disable-background-networking", "--disable-dev-shm-usage", "--use-gl=angle", "--use-angle=swiftshader",
      "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist", "--hide-scrollbars", "--force-color-profile=srgb",
      `--window-size=${width},${height}`, `--user-data-dir=${browser.profile}`, "about:blank"];
    browser.process = spawn("chromium", flags, { stdio: ["ignore", "ignore", "ignore", "pipe", "pipe"] });
    browser.process.on("error", (error) => { browser.dead = error; });
    browser.id = 0;
    browser.answers = new Map();
    browser.errors = [];
    browser.listen(browser.process.stdio[4]);
    const { targetInfos } = await browser.send("Target.getTargets");
    const { targetId } = targetInfos.find((target) => target.type === "page");
    browser.session = (await browser.send("Target.attachToTarget", { targetId, flatten: true })).sessionId;
    await browser.send("Page.enable");
    await browser.send("Runtime.enable");
    await browser.send("Emulation.setDeviceMetricsOverride", { width, height, deviceScaleFactor: 1, mobile: false });
    return browser;
  }

  listen(pipe) {
    let text = "";
    pipe.on("data", (data) => {
      text += data;
      for (let end; (end = text.indexOf("\0")) >= 0; text = text.slice(end + 1)) this.take(JSON.parse(text.slice(0, end)));
    });
  }

  take(message) {
    if (message.method === "Runtime.exceptionThrown") this.errors.push(message.params.exceptionDetails.exception?.description ?? message.params.exceptionDetails.text);
    if (message.method === "Runtime.consoleAPICalled" && message.params.type === "error") this.errors.push(JSON.stringify(message.params.args));
    const answer = this.answers.get(message.id);
    if (!answer) return;
    this.answers.delete(message.id);
    if (message.error) answer.reject(new Error(JSON.stringify(message.error)));
    else answer.resolve(message.result);
  }

  send(method, params = {}) {
    const id = ++this.id;
    this.process.stdio[3].write(JSON.stringify({ id, method, params, sessionId: this.session }) + "\0");
    return new Promise((resolve, reject) => this.answers.set(id, { resolve, reject }));
  }

  /** Seconds of processor time that Chromium's processes have used so far (Linux, 100 ticks a second). */
  async processorSeconds() {
    const parents = new Map(), ticks = new Map();
    for (const id of (await readdir("/proc")).filter((name) => /^\d+$/.test(name))) {
      const stat = await readFile(`/proc/${id}/stat`, "utf8").catch(() => null);
      if (stat === null) continue;
      const fields = stat.slice(stat.lastIndexOf(")") + 2).split(" ");
      parents.set(Number(id), Number(fields[1]));
      ticks.set(Number(id), Number(fields[11]) + Number(fields[12]));
    }
    const isOurs = (id) => id === this.process.pid || (id > 1 && isOurs(parents.get(id) ?? 0));
    return [...ticks].reduce((sum, [id, n]) => sum + (isOurs(id) ? n / 100 : 0), 0);
  }

  async open(url) { await this.send("Page.navigate", { url }); }

  /** The value of an expression in the page; promises are waited for. */
  async value(expression) {
    const { result, exceptionDetails } = await this.send("Runtime.evaluate", { expression, awaitPromise: true, returnByValue: true });
    if (exceptionDetails) throw new Error(exceptionDetails.exception?.description ?? exceptionDetails.text);
    return result.value;
  }

  async until(expression, seconds = 60) {
    for (const end = Date.now() + 1000 * seconds; Date.now() < end; ) {
      if (await this.value(expression)) return;
      await new Promise((resolve) => setTimeout(resolve, 50));
    }
    throw new Error(`not within ${seconds} s: ${expression}; ${this.errors.join("; ")}`);
  }

  async click(x, y) {
    for (const type of ["mousePressed", "mouseReleased"])
      await this.send("Input.dispatchMouseEvent", { type, x, y, button: "left", buttons: type === "mousePressed" ? 1 : 0, clickCount: 1 });
  }

  async drag(from, to) {
    const at = (type, [x, y], buttons) => this.send("Input.dispatchMouseEvent", { type, x, y, button: "left", buttons, clickCount: 1 });
    await at("mousePressed", from, 1);
    for (let k = 1; k <= 5; k++) await at("mouseMoved", from.map((n, axis) => n + (to[axis] - n) * k / 5), 1);
    await at("mouseReleased", to, 0);
  }

  async key(key, code = key) {
    for (const type of ["keyDown", "keyUp"]) await this.send("Input.dispatchKeyEvent", { type, key, code });
  }

  /** PNG in base64. */
  async screenshot() { return (await this.send("Page.captureScreenshot", { format: "png" })).data; }

  async stop() {
    const ended = new Promise((resolve) => this.process.on("exit", resolve));
    this.process.kill();
    await ended;
    await rm(this.profile, { recursive: true, force: true, maxRetries: 5 });
  }
}
