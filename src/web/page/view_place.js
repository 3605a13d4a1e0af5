/* The placement of the image on the stage: fitted, or zoomed about a point.
 * exports: createPlace(stage, view, changed) -> {scale, left, top, fitted, toScreen, fromScreen, zoom, fit, actual,
 * pan, size} */

const MARGIN = 12;
const LARGEST = 64;
const SMALLEST = 0.05;
const CRISP = 1.2; /* an image that would be enlarged by less is shown at actual pixels */

const whole = (x) => Math.round(x * devicePixelRatio) / devicePixelRatio;

export function createPlace(stage, view, changed) {
  const place = {
    scale: 1,
    left: 0,
    top: 0,
    fitted: true,
    width: 0,
    height: 0,
    toScreen: (x, y) => ({ x: place.left + x * place.scale, y: place.top + y * place.scale }),
    fromScreen: (x, y) => ({ x: (x - place.left) / place.scale, y: (y - place.top) / place.scale }),
    zoom,
    fit,
    actual,
    pan,
    size,
  };
  new ResizeObserver(() => size()).observe(stage);
  return place;

  function size() {
    const { clientWidth, clientHeight } = stage;
    if (!clientWidth || !clientHeight) return;
    const dx = (clientWidth - place.width) / 2;
    const dy = (clientHeight - place.height) / 2;
    place.width = clientWidth;
    place.height = clientHeight;
    if (place.fitted) fit();
    else {
      place.left += dx;
      place.top += dy;
      hold();
    }
  }

  function fit() {
    place.fitted = true;
    if (view.width && place.width) {
      place.scale = Math.max(
        SMALLEST / 4,
        Math.min((place.width - 2 * MARGIN) / view.width, (place.height - 2 * MARGIN) / view.height),
      );
      const enlarged = place.scale * devicePixelRatio;
      if (enlarged > 1 && enlarged < CRISP) place.scale = 1 / devicePixelRatio;
      place.left = whole((place.width - view.width * place.scale) / 2);
      place.top = whole((place.height - view.height * place.scale) / 2);
    }
    changed();
  }

  function zoom(factor, at = { x: place.width / 2, y: place.height / 2 }) {
    const { x, y } = place.fromScreen(at.x, at.y);
    place.fitted = false;
    place.scale = Math.min(LARGEST, Math.max(SMALLEST, place.scale * factor));
    place.left = at.x - x * place.scale;
    place.top = at.y - y * place.scale;
    hold();
  }

  function actual() {
    zoom(1 / (place.scale * devicePixelRatio));
    place.left = whole(place.left);
    place.top = whole(place.top);
    changed();
  }

  function pan(dx, dy) {
    place.fitted = false;
    place.left += dx;
    place.top += dy;
    hold();
  }

  /* Keeps the image over at least a quarter of the stage. */
  function hold() {
    const keep = (start, length, room) => Math.min(room * 0.75, Math.max(room * 0.25 - length, start));
    place.left = keep(place.left, view.width * place.scale, place.width);
    place.top = keep(place.top, view.height * place.scale, place.height);
    changed();
  }
}
