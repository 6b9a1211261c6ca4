// Pointers over a plot: a drag goes through time, the wheel and two fingers zoom, and a drag with Shift or the right button shifts the plot.

/** How much a turn of the wheel by one pixel zooms, how much two fingers on a touchpad do, and the farthest turn of one event. */
const [WHEEL, TOUCHPAD, FARTHEST] = [0.0018, 0.01, 120];

/**
 * Calls the functions of `plot`: `go(place)`, `zoom(place, factor)`, `shift(x, y)`, `showAll()`, and `point(place)`, without a place when the pointer
 * leaves. Places and distances are in pixels of the canvas.
 */
export function watch(canvas, plot) {
  const held = new Map();
  let shifts = false;
  const placeOf = (event) => {
    const box = canvas.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  };
  canvas.onpointerdown = (event) => {
    canvas.setPointerCapture(event.pointerId);
    held.set(event.pointerId, placeOf(event));
    shifts = event.shiftKey || event.button === 2;
    if (held.size === 1 && !shifts) plot.go(placeOf(event));
  };
  canvas.onpointermove = (event) => {
    const [now, last] = [placeOf(event), held.get(event.pointerId)];
    if (event.pointerType !== "touch") plot.point(now);
    if (!last) return;
    if (held.size === 2) pinch(event.pointerId, last, now);
    else if (shifts) plot.shift(now[0] - last[0], now[1] - last[1]);
    else if (held.size === 1) plot.go(now);
    held.set(event.pointerId, now);
  };
  function pinch(moving, last, now) {
    const [other] = [...held].filter(([id]) => id !== moving).map(([, place]) => place);
    const away = (place) => Math.max(10, Math.hypot(place[0] - other[0], place[1] - other[1]));
    const middle = [(now[0] + other[0]) / 2, (now[1] + other[1]) / 2];
    plot.shift((now[0] - last[0]) / 2, (now[1] - last[1]) / 2);
    plot.zoom(middle, away(last) / away(now));
    // What remains of the gesture shifts the plot, so that it does not jump to another time.
    shifts = true;
  }
  const end = (event) => held.delete(event.pointerId);
  canvas.onpointerup = end;
  canvas.onpointercancel = end;
  canvas.onpointerleave = () => plot.point(undefined);
  canvas.oncontextmenu = (event) => event.preventDefault();
  canvas.ondblclick = (event) => event.shiftKey || plot.showAll();
  canvas.onwheel = (event) => {
    event.preventDefault();
    const turn = (delta) => Math.max(-FARTHEST, Math.min(FARTHEST, delta));
    if (Math.abs(event.deltaX) > Math.abs(event.deltaY)) plot.shift(-turn(event.deltaX), 0);
    // Browsers report two fingers on a touchpad as a wheel with the Control key.
    else plot.zoom(placeOf(event), Math.exp((event.ctrlKey ? TOUCHPAD : WHEEL) * turn(event.deltaY)));
  };
}
