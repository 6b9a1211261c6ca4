// Tests of the plots below the picture, on the static page.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { deflateRawSync } from "node:zlib";

import { drawn, newPage, seek, tests, until } from "../preview/browser.mjs";

const BALL = "[simulation]\nduration = 2\nframe_rate = 50\ngravity = [0, -10, 0]\nintegrator = 'rk4'\n\n[body.ball]\nshape.sphere.radius = 0.5\nlocation = [0, 3, 0]\nvelocity = [1, 0, 0]\n";
/** A run of more frames than a plot has points. */
const LONG_RUN = BALL.replace("duration = 2", "duration = 200");
const link = (text) => `#scene=${deflateRawSync(JSON.stringify(["ball", text])).toString("base64url")}`;

/** Opens the page with a scene, and waits until its plot is complete. */
async function opened({ address, keep, browser }, { text = BALL, hash = link(text), ...options } = {}) {
  const page = keep(await newPage(browser, { size: { width: 1280, height: 800 }, ...options }));
  await page.goto(address + hash);
  await until(page, (jabuka) => jabuka?.settled && jabuka.drawn.count > 0 && jabuka.plot.curves[0]?.times.at(-1) >= (jabuka.frames - 1) / 51);
  await page.locator("#plot").scrollIntoViewIfNeeded();
  return page;
}

const plot = (page) => page.evaluate(() => window.jabuka.plot);

/** Returns the point of the page at parts of the area of the curves: 0 to 1 across, and 0 to 1 down. */
async function place(page, across, down) {
  const { area } = await plot(page);
  const { x, y } = await page.locator("#plot").boundingBox();
  return [x + area.left + across * area.width, y + area.top + down * area.height];
}

async function choose(page, quantity, against) {
  await page.locator("#plotted").selectOption(quantity);
  if (against) await page.locator("#against").selectOption(against);
  await until(page, (jabuka, is) => jabuka.plot.curves.length === is && jabuka.plot.curves[0].times.length > 1, against || /energy|impacts/.test(quantity) ? 1 : 3);
}

async function chooseBody(page, name = "ball") {
  await page.fill("#body-name", name);
  await page.press("#body-name", "Enter");
  await until(page, (jabuka, name) => jabuka.selected === name, name);
  await page.evaluate(() => document.activeElement.blur());
}

async function saved(page, button) {
  const download = page.waitForEvent("download");
  await page.locator(button).click();
  const file = await download;
  return { name: file.suggestedFilename(), text: readFileSync(await file.path(), "utf8") };
}

const nearly = (a, b, slack, what) => assert.ok(Math.abs(a - b) <= slack, `${what}: ${a}, not ${b}`);

await tests({
  async both_axes_have_numbers_and_units_that_can_be_read(all) {
    for (const [width, height] of [[360, 640], [640, 380], [1280, 800], [1920, 1080]]) {
      const page = await opened(all, { size: { width, height }, hash: "#gallery=newtons_cradle" });
      await chooseBody(page, "ball[0]");
      const { width: wide, height: high } = await page.locator("#plot").boundingBox();
      for (const [quantity, unit] of [["Energy", "Energy (J)"], ["Drift", "Drift"], ["Impacts", "Impacts"], ["Body: angular velocity", "(rad/s)"], ["Body: force", "(N)"]]) {
        await page.locator("#plotted").selectOption(quantity);
        await until(page, (jabuka, unit) => jabuka.plot.texts[0].text.includes(unit), unit);
        const { texts, area } = await plot(page);
        const said = `${quantity}, ${width} × ${height}: ${texts.map(({ text }) => text)}`;
        assert.ok(texts.some(({ text }) => text === "t (s)"), said);
        for (const { text, box: [left, top, right, bottom] } of texts) assert.ok(left >= 0 && top >= 0 && right <= wide && bottom <= high, `${text} is cut: ${said}`);
        for (const [k, { text, box: a }] of texts.entries()) {
          const covered = texts.slice(0, k).find(({ box: b }) => a[0] < b[2] && b[0] < a[2] && a[1] < b[3] - 0.5 && b[1] < a[3] - 0.5);
          assert.equal(covered, undefined, `${text} covers ${covered?.text}: ${said}`);
        }
        const numbers = texts.filter(({ text }) => /^[−\d.e]+$/.test(text));
        assert.ok(numbers.filter(({ box }) => box[2] < area.left).length >= 2, said);
        assert.ok(numbers.filter(({ box }) => box[1] > area.top + area.height).length >= 3, said);
      }
      await all.close(page);
    }
  },

  async curves_have_names_at_their_ends_in_wide_windows_and_values_in_the_legend(all) {
    const page = await opened(all);
    const { texts, area, y, curves } = await plot(page);
    const names = texts.filter(({ box }) => box[0] > area.left + area.width && box[1] < area.top + area.height);
    assert.deepEqual(names.map(({ text }) => text), ["kinetic", "potential", "total"]);
    const total = curves.find(({ name }) => name === "total");
    const end = area.top + area.height * (1 - (total.ys.at(-1) - y[0]) / (y[1] - y[0]));
    const [, top, , bottom] = names[2].box;
    nearly((top + bottom) / 2, end, 15, "the name of the total energy");
    await seek(page, 50);
    // The ball of 1 kg falls with 10 m/s, and moves with 1 m/s to the side.

    const [kinetic] = await page.locator("#legend dd").allTextContents();
    nearly(Number(kinetic.replace(" J", "")) / 50.5, 1, 1e-3, `the kinetic energy of ${kinetic}`);
    await page.setViewportSize({ width: 360, height: 640 });
    await until(page, (jabuka) => !jabuka.plot.texts.some(({ text }) => text === "kinetic"));
    assert.deepEqual(await page.locator("#legend dt").allTextContents(), ["kinetic", "potential", "total"]);
  },

  async a_click_and_a_drag_go_to_that_time(all) {
    const page = await opened(all);
    for (const part of [0.5, 0.9, 0]) {
      await page.mouse.click(...(await place(page, part, 0.5)));
      nearly(await drawn(page), 100 * part, 1, `the frame at ${part}`);
    }
    await page.mouse.move(...(await place(page, 0.2, 0.5)));
    await page.mouse.down();
    await page.mouse.move(...(await place(page, 0.7, 0.1)), { steps: 4 });
    nearly(await drawn(page), 70, 1, "the frame after a drag");
    // Beside the curves, the ends of the run are meant.
    const { x, y, width } = await page.locator("#plot").boundingBox();
    await page.mouse.move(x + width - 1, y + 30);
    assert.equal(await drawn(page), 100);
    await page.mouse.up();
  },

  async the_pointer_shows_values_and_leaves_nothing_behind(all) {
    const page = await opened(all);
    const picture = () => page.evaluate(() => document.getElementById("plot").toDataURL());
    const before = await picture();
    const [x, y] = await place(page, 0.5, 0.5);
    await page.mouse.move(x, y);
    const shown = await picture();
    assert.notEqual(shown, before);
    await page.mouse.move(x + 100, y);
    assert.notEqual(await picture(), shown);
    await page.mouse.move(x, y - 400);
    assert.equal(await picture(), before);
  },

  async the_wheel_zooms_about_the_pointer_and_a_drag_with_shift_shifts(all) {
    const page = await opened(all);
    const whole = await plot(page);
    assert.deepEqual(whole.x, [0, 2]);
    const point = await place(page, 0.75, 0.5);
    await page.mouse.move(...point);
    for (let k = 0; k < 5; k++) await page.mouse.wheel(0, -100);
    await until(page, (jabuka) => jabuka.plot.x[1] - jabuka.plot.x[0] < 1);
    const near = await plot(page);
    nearly(near.x[0] + 0.75 * (near.x[1] - near.x[0]), 1.5, 0.02, "the time below the pointer");
    assert.ok(near.y[0] > whole.y[0], `the axis up fits what is shown: ${near.y}, of ${whole.y}`);
    const drag = async (deed, by) => {
      const [x, y] = await place(page, 0.5, 0.5);
      const { x: before, area } = await plot(page);
      await page.mouse.move(x, y);
      await deed(async (options) => {
        await page.mouse.down(options);
        await page.mouse.move(x + by, y, { steps: 3 });
        await page.mouse.up(options);
      });
      const { x: after } = await plot(page);
      const expected = Math.max(0, before[0] - (by / area.width) * (before[1] - before[0]));
      nearly(after[0], expected, 0.02, "the first time after a drag");
      nearly(after[1] - after[0], before[1] - before[0], 1e-9, "the range after a drag");
    };
    const frame = await drawn(page);
    await drag(async (move) => (await page.keyboard.down("Shift"), await move(), await page.keyboard.up("Shift")), 120);
    await drag((move) => move({ button: "right" }), -60);
    await drag((move) => move({ button: "right" }), 5000);
    assert.equal(await drawn(page), frame, "a shift does not go to another time");
    await page.mouse.dblclick(...(await place(page, 0.5, 0.5)));
    assert.deepEqual((await plot(page)).x, [0, 2]);
  },

  async keys_zoom_the_plot_that_has_the_focus_and_move_the_time(all) {
    const page = await opened(all);
    await seek(page, 40);
    await page.locator("#plot").focus();
    await page.keyboard.press("+");
    await page.keyboard.press("+");
    const near = await plot(page);
    nearly((0.8 - near.x[0]) / (near.x[1] - near.x[0]), 0.4, 1e-6, "the place of the present moment");
    nearly(near.x[1] - near.x[0], 2 / 1.5 ** 2, 1e-6, "the shown range");
    assert.equal(await page.locator("#speed").inputValue(), "1", "the keys do nothing else");
    // The plot follows the time that leaves it.
    await page.keyboard.press("ArrowRight");
    assert.equal(await drawn(page), 41);
    for (let k = 0; k < 3; k++) await page.keyboard.press("Shift+ArrowRight");
    assert.equal(await drawn(page), 71);
    const after = await plot(page);
    assert.ok(after.x[0] <= 1.42 && after.x[1] >= 1.42, `${after.x}`);
    await page.keyboard.press("-");
    await page.keyboard.press("0");
    assert.deepEqual((await plot(page)).x, [0, 2]);
  },

  async values_are_told_when_they_are_asked_for(all) {
    const page = await opened(all);
    await page.locator("#plot").focus();
    await page.keyboard.press("ArrowRight");
    await drawn(page);
    const said = page.locator("#plot-said");
    assert.equal(await said.textContent(), "");
    await page.keyboard.press("Enter");
    assert.match(await said.textContent(), /^t 0\.02 s: kinetic [\d.]+ J, potential [−\d.]+ J, total [−\d.]+ J$/);
    assert.match(await page.locator("#plot").getAttribute("aria-label"), /Energy over time/);
  },

  async two_fingers_zoom(all) {
    const page = await opened(all, { size: { width: 390, height: 844 }, hasTouch: true, isMobile: true });
    const client = await page.context().newCDPSession(page);
    const touch = async (type, ...parts) => {
      const points = await Promise.all(parts.map((part) => place(page, part, 0.5)));
      await client.send("Input.dispatchTouchEvent", { type, touchPoints: points.map(([x, y], id) => ({ x, y, id })) });
    };
    await touch("touchStart", 0.4);
    await touch("touchStart", 0.4, 0.6);
    const frame = await drawn(page);
    for (const away of [0.15, 0.2, 0.25, 0.3]) await touch("touchMove", 0.5 - away, 0.5 + away);
    await touch("touchEnd");
    const { x } = await plot(page);
    assert.ok(x[1] - x[0] < 1 && x[1] - x[0] > 0.4, `${x}`);
    nearly((x[0] + x[1]) / 2, 1, 0.2, "the middle");
    assert.equal(await drawn(page), frame, "the gesture does not go to another time");
  },

  async a_zoomed_plot_has_every_frame(all) {
    const page = await opened(all, { text: LONG_RUN });
    await page.waitForTimeout(300);
    const coarse = await plot(page);
    assert.ok(coarse.curves[0].times.length <= 4000, `${coarse.curves[0].times.length}`);
    await page.mouse.move(...(await place(page, 0.5, 0.5)));
    for (let k = 0; k < 12; k++) await page.mouse.wheel(0, -120);
    const steps = (times) => times.slice(1).map((time, k) => time - times[k]);
    nearly(steps(coarse.curves[0].times)[0], 0.06, 1e-9, "the time between two points");
    await until(page, (jabuka) => jabuka.plot.curves[0].times[1] - jabuka.plot.curves[0].times[0] < 0.021);
    const { x, curves: [{ times, ys }] } = await plot(page);
    assert.ok(times[0] <= x[0] && times.at(-1) >= x[1], `${times[0]} to ${times.at(-1)} of ${x}`);
    assert.ok(Math.max(...steps(times)) < 0.021 && times.length < 10_001);
    // These are the values of those times.

    nearly(ys[7] / (0.5 * (1 + (10 * times[7]) ** 2)), 1, 1e-9, "the kinetic energy");
    await page.mouse.dblclick(...(await place(page, 0.5, 0.5)));
    assert.deepEqual((await plot(page)).curves[0].times, coarse.curves[0].times);
  },

  async a_path_and_a_phase_plot_are_of_the_chosen_body(all) {
    const page = await opened(all);
    await page.locator("#plotted").selectOption("Body: location");
    await until(page, (jabuka) => jabuka.plot.texts.some(({ text }) => text.startsWith("Choose a body")));
    await chooseBody(page);
    await choose(page, "Body: location", "x – y");
    const path = await plot(page);
    assert.deepEqual([path.texts[0].text, path.texts[1].text], ["ball: y (m)", "x (m)"]);
    const [curve] = path.curves;
    for (const k of [0, 40, 100]) {
      nearly(curve.xs[k], curve.times[k], 1e-9, "x");
      nearly(curve.ys[k], 3 - 5 * curve.times[k] ** 2, 1e-9, "y");
    }
    nearly((path.x[1] - path.x[0]) / path.area.width, (path.y[1] - path.y[0]) / path.area.height, 1e-9, "a length across and up");
    // A click goes to the time of the nearest point.
    const { area, x, y } = path;
    await page.mouse.click(...(await place(page, (curve.xs[60] - x[0]) / (x[1] - x[0]), (y[1] - curve.ys[60]) / (y[1] - y[0]))));
    nearly(await drawn(page), 60, 1, "the frame at a point of the path");
    await page.mouse.wheel(0, -300);
    await until(page, (jabuka, before) => jabuka.plot.x[1] - jabuka.plot.x[0] < before, 0.9 * (x[1] - x[0]));
    const near = await plot(page);
    nearly((near.x[1] - near.x[0]) / near.area.width, (near.y[1] - near.y[0]) / near.area.height, 1e-3 / area.width, "a length across and up, zoomed");
    await choose(page, "Body: velocity", "y – vy");
    await until(page, (jabuka) => jabuka.plot.texts[0].text === "ball: vy (m/s)");
    const phase = await plot(page);
    nearly(phase.curves[0].ys[50], -10, 1e-9, "vy");
    nearly(phase.curves[0].xs[50], -2, 1e-9, "y");
    assert.deepEqual(await page.locator("#legend dt").allTextContents(), ["y", "vy"]);
  },

  async two_runs_are_compared_and_subtracted(all) {
    const page = await opened(all);
    await chooseBody(page);
    await choose(page, "Body: location");
    assert.equal(await page.locator("#difference").isVisible(), false);
    await page.locator("#other-integrator").selectOption("explicit-euler");
    await page.fill("#other-step", "0.02");
    await page.press("#other-step", "Enter");
    // Explicit Euler with steps of h is a t h / 2 too high.
    await until(page, (jabuka, apart) => {
      const { curves } = jabuka.plot;
      return curves.length === 6 && Math.abs(curves[4].ys[100] - curves[1].ys[100] - apart) < 1e-9;
    }, (10 * 2 * 0.02) / 2);
    const { curves, texts } = await plot(page);
    assert.ok(texts.some(({ text }) => text === "rk4") && texts.some(({ text }) => text === "explicit-euler"));
    const both = await saved(page, "#plot-csv");
    const [heading, ...rows] = both.text.trim().split("\n");
    assert.equal(heading, "t (s),rk4: x (m),rk4: y (m),rk4: z (m),explicit-euler: x (m),explicit-euler: y (m),explicit-euler: z (m)");
    assert.deepEqual(rows[77].split(",").map(Number), [curves[0].times[77], ...curves.map(({ ys }) => ys[77])]);
    await page.locator("#difference").check();
    const difference = await plot(page);
    assert.equal(difference.texts[0].text, "ball: location, difference (m)");
    assert.equal(difference.curves.length, 3);
    nearly(difference.curves[1].ys[100], -0.2, 1e-9, "the difference");
    assert.equal((await saved(page, "#plot-csv")).name, "ball-ball-location-difference.csv");
    await page.locator("#other-integrator").selectOption("");
    await until(page, (jabuka) => jabuka.plot.curves.length === 3 && jabuka.plot.texts[0].text === "ball: location (m)");
  },

  async a_table_has_every_digit_of_what_is_shown(all) {
    const page = await opened(all, { text: LONG_RUN });
    const { name, text } = await saved(page, "#plot-csv");
    assert.equal(name, "ball-energy.csv");
    const rows = text.trim().split("\n");
    assert.equal(rows[0], "t (s),kinetic (J),potential (J),total (J)");
    assert.equal(rows.length, 1 + 10_001, "every frame, also those between two points of the plot");
    const { curves } = await plot(page);
    const k = 1234;
    const at = 1 + Math.round(curves[0].times[k] * 50);
    assert.deepEqual(rows[at].split(",").map(Number), [curves[0].times[k], ...curves.map(({ ys }) => ys[k])]);
    // A zoomed plot gives the rows of its range.
    await page.locator("#plot").focus();
    for (let n = 0; n < 6; n++) await page.keyboard.press("+");
    const { x } = await plot(page);
    const shown = (await saved(page, "#plot-csv")).text.trim().split("\n").slice(1).map((row) => Number(row.split(",")[0]));
    assert.ok(shown[0] >= x[0] && shown[0] < x[0] + 0.02 && shown.at(-1) <= x[1] && shown.at(-1) > x[1] - 0.02, `${shown[0]} to ${shown.at(-1)} of ${x}`);
  },

  async a_drawing_can_be_opened_anywhere(all) {
    for (const colorScheme of ["light", "dark"]) {
      const page = await opened(all, { colorScheme });
      const { name, text } = await saved(page, "#plot-svg");
      assert.equal(name, "ball-energy.svg");
      const { error, texts, width, height, colors } = await page.evaluate(async (text) => {
        const parsed = new DOMParser().parseFromString(text, "image/svg+xml");
        const image = new Image();
        image.src = URL.createObjectURL(new Blob([text], { type: "image/svg+xml" }));
        await image.decode();
        const canvas = Object.assign(document.createElement("canvas"), { width: image.naturalWidth, height: image.naturalHeight });
        const context = canvas.getContext("2d");
        context.drawImage(image, 0, 0);
        const { data } = context.getImageData(0, 0, canvas.width, canvas.height);
        const colors = {};
        for (let k = 0; k < data.length; k += 4) {
          const color = data.slice(k, k + 4).join();
          colors[color] = (colors[color] ?? 0) + 1;
        }
        return { error: parsed.querySelector("parsererror")?.textContent, texts: [...parsed.querySelectorAll("text")].map((each) => each.textContent), width: canvas.width, height: canvas.height, colors };
      }, text);
      assert.equal(error, undefined);
      for (const word of ["Energy (J)", "t (s)", "kinetic", "potential", "total", "0.0", "1.0"]) assert.ok(texts.includes(word), `${word}: ${texts}`);
      assert.ok(width > 600 && height > 300, `${width} × ${height}`);
      assert.ok(colors["255,255,255,255"] > 0.8 * width * height, "the paper is white");
      for (const color of ["196,69,28,255", "22,87,184,255", "27,36,48,255"]) assert.ok(colors[color] > 100, `${colorScheme}: ${color}`);
      await all.close(page);
    }
  },

  async a_plot_can_be_enlarged_for_the_blackboard(all) {
    for (const size of [{ width: 1280, height: 800 }, { width: 360, height: 640 }]) {
      const page = await opened(all, { size });
      const height = async () => (await page.locator("#plot").boundingBox()).height;
      const before = await height();
      const button = page.getByRole("button", { name: "Enlarge" });
      for (const back of [() => button.click(), () => page.keyboard.press("Escape")]) {
        await button.click();
        assert.equal(await button.getAttribute("aria-pressed"), "true");
        assert.ok((await height()) >= 0.45 * size.height, `${await height()}`);
        await back();
        assert.equal(await button.getAttribute("aria-pressed"), "false");
        assert.equal(await height(), before);
      }
      await all.close(page);
    }
  },

  async a_run_of_one_frame_and_a_body_that_comes_later_are_plotted(all) {
    const one = await opened(all, { text: BALL.replace("duration = 2", "duration = 0") });
    const { curves: single, x, texts } = await plot(one);
    assert.deepEqual([single.map(({ times }) => times), x], [[[0], [0], [0]], [0, 1]]);
    assert.ok(texts.some(({ text }) => text === "0.5"), `${texts.map(({ text }) => text)}`);
    await one.mouse.click(...(await place(one, 0.5, 0.5)));
    assert.equal(await drawn(one), 0);
    const page = await opened(all, { text: `${BALL}start = 1\n` });
    await chooseBody(page);
    await choose(page, "Body: location");
    const { curves, y } = await page.evaluate(() => ({ ...window.jabuka.plot, curves: window.jabuka.plot.curves.map(({ ys }) => ys.filter((value) => !Number.isNaN(value)).length) }));
    assert.deepEqual(curves, [51, 51, 51]);
    assert.ok(y[0] > -3 && y[1] < 4, `${y}`);
    assert.equal(await page.locator("#legend dd").first().textContent(), "–");
  },
});
