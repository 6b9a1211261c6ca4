// What the modules of the page have in common: the elements of the page, and what is open.

import { Panel } from "./panel.js";
import { Player } from "./player.js";
import { Plots } from "./plots.js";
import { Texts } from "./texts.js";
import { Viewpoint } from "./viewpoint.js";

export const element = (id) => document.getElementById(id);

/** The server's state, the run that is shown, the one that it is compared with, what draws them. */
export const open = { state: null, run: null, other: null, view: 0, serial: 0, gone: false, painter: undefined };

/** What has been drawn last, and whether that is still right; `waiting` are those who wait for a frame. */
export const drawn = { count: 0, run: null, frame: -1, view: null, dirty: true, waiting: [] };

export const player = new Player();
export const viewpoint = new Viewpoint();
export const panel = new Panel({ name: element("body-name"), names: element("body-names"), values: element("body-values") });
export const plots = new Plots({ canvas: element("plot"), choice: element("plotted"), legend: element("legend"), drift: element("drift") });
export const texts = new Texts(element("texts"));

/** Something is to be seen that has not been drawn. */
export function redraw() {
  drawn.dirty = true;
}
