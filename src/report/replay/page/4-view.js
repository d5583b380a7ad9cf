// The canvas and the part of the arena that it shows: fit, zoom, pan, touch.

const scene = byId('scene');
const pen = scene.getContext('2d', { alpha: false });
const view = { wide: 0, high: 0, dots: 1, x: 0, y: 0, scale: 1, fitted: true, dirty: true };
const [arenaWide, arenaHigh] = meta.arena;
const screenX = new Float32Array(robots);
const screenY = new Float32Array(robots);

const toScreenX = x => view.wide / 2 + (x - view.x) * view.scale;
const toScreenY = y => view.high / 2 - (y - view.y) * view.scale;
// Above and under the arena there is room for the time and the scale.
const MARGIN = 32;
const fitScale = () => Math.max(1e-6, Math.min((view.wide - 20) / arenaWide, (view.high - 2 * MARGIN) / arenaHigh));

/** Something has changed, so the next frame of the browser draws. */
function redraw() { view.dirty = true; }

function fit() {
  view.x = view.y = 0;
  view.scale = fitScale();
  view.fitted = true;
  // A whole arena needs no panning, so a finger on it may scroll the page.
  scene.style.touchAction = 'pan-y';
  redraw();
}

/** Zooms about a point of the canvas, which stays where it is. */
function zoom(factor, x, y) {
  const scale = clamp(view.scale * factor, fitScale() * 0.8, Math.max(fitScale() * 2, 400 / meta.body_radius_m / 8));
  view.x += (x - view.wide / 2) * (1 / view.scale - 1 / scale);
  view.y -= (y - view.high / 2) * (1 / view.scale - 1 / scale);
  view.scale = scale;
  view.fitted = false;
  scene.style.touchAction = 'none';
  redraw();
}

function pan(byX, byY) {
  view.x = clamp(view.x - byX / view.scale, -arenaWide, arenaWide);
  view.y = clamp(view.y + byY / view.scale, -arenaHigh, arenaHigh);
  view.fitted = false;
  scene.style.touchAction = 'none';
  redraw();
}

/** The picture takes the shape of the arena, as far as the window has room for it. */
function layOut() {
  const page = byId('main');
  const room = page.clientWidth;
  const tallest = Math.max(280, innerHeight * 0.62);
  // A window that is opening or closing may have no width for a moment.
  if (room < 60) return;
  const beside = room >= 860;
  const widest = beside ? room - 344 : room;
  const shape = clamp(arenaWide / arenaHigh, 0.5, 3);
  const wide = beside ? clamp((tallest - 2 * MARGIN) * shape + 20, Math.min(560, widest), widest) : room;
  page.style.setProperty('--stage', Math.round(wide) + 'px');
  // Beside a narrow picture there is room for the charts.
  page.classList.toggle('narrow', beside && wide < room * 0.56);
  view.wide = Math.round(wide) - 2;
  view.high = Math.round(Math.min(tallest, (wide - 20) / shape + 2 * MARGIN));
  view.dots = Math.min(devicePixelRatio || 1, 2);
  scene.style.height = view.high + 'px';
  const width = Math.round(view.wide * view.dots);
  const height = Math.round(view.high * view.dots);
  // Setting the size clears a canvas and ends a video of it: only when it is new.
  if (scene.width !== width) scene.width = width;
  if (scene.height !== height) scene.height = height;
  if (view.fitted) fit(); else redraw();
}

/** The robot under a point of the canvas, or -1. */
function robotAt(x, y, reach) {
  let best = -1;
  let least = reach * reach;
  for (let robot = 0; robot < robots; robot++) {
    if (!roles.shown[roles.value[robot]]) continue;
    const distance = (screenX[robot] - x) ** 2 + (screenY[robot] - y) ** 2;
    if (distance < least) { least = distance; best = robot; }
  }
  return best;
}

function listenToScene(onRobot) {
  const pointers = new Map();
  let moved = false;
  const at = event => {
    const box = scene.getBoundingClientRect();
    return { x: event.clientX - box.left, y: event.clientY - box.top };
  };
  scene.addEventListener('pointerdown', event => {
    if (event.button !== 0) return;
    if (pointers.size === 0) moved = false;
    pointers.set(event.pointerId, at(event));
    scene.setPointerCapture(event.pointerId);
  });
  scene.addEventListener('pointermove', event => {
    const before = pointers.get(event.pointerId);
    if (!before) return;
    const after = at(event);
    if (pointers.size === 1) {
      if (!moved && Math.hypot(after.x - before.x, after.y - before.y) < 5) return;
      moved = true;
      if (now.keepCentred) setCentred(false);
      pan(after.x - before.x, after.y - before.y);
    } else if (pointers.size === 2) {
      moved = true;
      let other;
      for (const [id, place] of pointers) if (id !== event.pointerId) other = place;
      const apart = Math.hypot(before.x - other.x, before.y - other.y);
      if (apart > 0) zoom(Math.hypot(after.x - other.x, after.y - other.y) / apart, (after.x + other.x) / 2, (after.y + other.y) / 2);
      pan((after.x - before.x) / 2, (after.y - before.y) / 2);
    }
    pointers.set(event.pointerId, after);
  });
  scene.addEventListener('pointerup', event => {
    if (pointers.delete(event.pointerId) && !moved && pointers.size === 0) {
      const place = at(event);
      const robot = robotAt(place.x, place.y, event.pointerType === 'mouse' ? 14 : 26);
      if (robot >= 0) onRobot(robot);
    }
  });
  scene.addEventListener('pointercancel', event => pointers.delete(event.pointerId));
  scene.addEventListener('dblclick', () => { setCentred(false); fit(); });
  scene.addEventListener('wheel', event => {
    event.preventDefault();
    const place = at(event);
    // One notch of a wheel is about 100: a fifth closer.
    zoom(Math.exp(-clamp(event.deltaY, -300, 300) * 0.0018), place.x, place.y);
  }, { passive: false });
}
