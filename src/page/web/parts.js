// State and objects that the modules of the page share: the elements of the page, and the open runs.

import { Panel } from "./body/panel.js";
import { Player } from "./run/player.js";
import { Plots } from "./plots/plots.js";
import { Texts } from "./picture/texts.js";
import { Viewpoint } from "./picture/viewpoint.js";

export const element = (id) => document.getElementById(id);

/** The server's state, the shown run (`run`), the run that it is compared with (`other`), and the painter of both. */
export const open = { state: null, run: null, other: null, view: 0, serial: 0, gone: false, painter: undefined };

/** The frame that was drawn last, its view and its camera, and whether it must be drawn again (`dirty`). `waiting` holds callbacks for the next drawn frame. */
export const drawn = { count: 0, run: null, frame: -1, view: null, camera: null, dirty: true, waiting: [] };

export const player = new Player();
export const viewpoint = new Viewpoint();
export const panel = new Panel({ name: element("body-name"), names: element("body-names"), values: element("body-values"), shows: element("body-shows"), showsContacts: element("show-contacts").parentElement });
export const plots = new Plots({
  frame: element("plots"), canvas: element("plot"), choice: element("plotted"), against: element("against"), difference: element("difference"),
  legend: element("legend"), drift: element("drift"), csv: element("plot-csv"), svg: element("plot-svg"), enlarge: element("plot-enlarge"), said: element("plot-said"),
});
export const texts = new Texts(element("texts"));

/** Marks the picture as outdated, so that it is drawn again. */
export function redraw() {
  drawn.dirty = true;
}
