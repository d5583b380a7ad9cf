// The picture. Shapes of one colour share one path: calls, not shapes, are what costs.

const TURN = Math.PI * 2;
const font = '12px system-ui, sans-serif';

/** Robots are never smaller than this on the screen, or a wide arena would look empty. */
function robotRadius() {
  const least = robots <= 100 ? 4 : robots <= 600 ? 3 : robots <= 2000 ? 2.4 : 1.8;
  return Math.max(least, meta.body_radius_m * view.scale);
}

function line(x1, y1, x2, y2) { pen.moveTo(x1, y1); pen.lineTo(x2, y2); }

function drawGround() {
  pen.fillStyle = '#ffffff';
  pen.fillRect(0, 0, view.wide, view.high);
  pen.strokeStyle = '#999999';
  pen.lineWidth = 1;
  pen.strokeRect(toScreenX(-arenaWide / 2), toScreenY(arenaHigh / 2), arenaWide * view.scale, arenaHigh * view.scale);
  pen.fillStyle = '#d5d5d5';
  pen.strokeStyle = '#8a8a8a';
  pen.lineWidth = 2;
  pen.beginPath();
  for (const { disc } of meta.obstacles) {
    if (!disc) continue;
    pen.moveTo(toScreenX(disc[0] + disc[2]), toScreenY(disc[1]));
    pen.arc(toScreenX(disc[0]), toScreenY(disc[1]), disc[2] * view.scale, 0, TURN);
  }
  pen.fill();
  pen.beginPath();
  for (const { wall } of meta.obstacles) {
    if (wall) line(toScreenX(wall[0]), toScreenY(wall[1]), toScreenX(wall[2]), toScreenY(wall[3]));
  }
  pen.lineWidth = 3;
  pen.stroke();
  pen.strokeStyle = ink;
  pen.lineWidth = 1.5;
  pen.beginPath();
  for (const [x, y] of meta.targets) {
    const left = toScreenX(x);
    const top = toScreenY(y);
    pen.moveTo(left, top - 9); pen.lineTo(left + 9, top); pen.lineTo(left, top + 9); pen.lineTo(left - 9, top);
    pen.closePath();
  }
  pen.stroke();
}

function drawChains() {
  if (relies.size === 0) return;
  pen.strokeStyle = '#f0d9a0';
  pen.lineWidth = clamp(robotRadius() * 1.6, 7, 16);
  pen.lineJoin = pen.lineCap = 'round';
  pen.beginPath();
  for (const [robot, changes] of relies) {
    for (const other of reliedOn(changes, now.t)) {
      pen.moveTo(screenX[robot], screenY[robot]);
      pen.lineTo(screenX[other], screenY[other]);
    }
  }
  pen.stroke();
  pen.lineCap = 'butt';
}

let linksDrawn = 0;
function drawLinks() {
  linksDrawn = 0;
  if (!linksKnown || !now.showLinks) return;
  const every = roles.shown.every(Boolean);
  const { a, b, length } = links;
  // A line of at most one dot of the screen is drawn many times faster than a wider one.
  pen.lineWidth = 1 / view.dots;
  pen.strokeStyle = robots > 400 ? '#d3d6d9' : '#b9bec3';
  pen.beginPath();
  for (let i = 0; i < length; i++) {
    const from = a[i];
    const to = b[i];
    if (!every && !(roles.shown[roles.value[from]] && roles.shown[roles.value[to]])) continue;
    pen.moveTo(screenX[from], screenY[from]);
    pen.lineTo(screenX[to], screenY[to]);
    linksDrawn++;
    // Pieces: one path of tens of thousands of lines costs more than its parts.
    if ((linksDrawn & 255) === 0) { pen.stroke(); pen.beginPath(); }
  }
  pen.stroke();
}

function drawTrail() {
  if (!now.showTrail || now.followed < 0 || now.frame === 0) return;
  // The last ten seconds, walked back from the frame along the differences of one robot.
  const quantum = meta.frames.quantum_m;
  const from = now.followed * steps;
  const oldest = Math.max(0, now.frame - Math.min(400, Math.round(10 / meta.frames.every_s)));
  let x = cursor.x[now.followed];
  let y = cursor.y[now.followed];
  pen.strokeStyle = ink;
  pen.lineWidth = 1;
  pen.beginPath();
  pen.moveTo(screenX[now.followed], screenY[now.followed]);
  for (let i = now.frame; ; i--) {
    pen.lineTo(toScreenX(x * quantum), toScreenY(y * quantum));
    if (i <= oldest) break;
    x -= columns.dx[from + i - 1];
    y -= columns.dy[from + i - 1];
  }
  pen.stroke();
}

const LINE_STRENGTH = [0.85, 0.6, 0.4, 0.2];
function drawMessages(radius) {
  const detail = messageDetail();
  if (detail === 'none') return;
  if (detail === 'lines') {
    pen.lineWidth = 1;
    // Thousands of lines at full strength would hide the robots.
    const strength = clamp(500 / near.lines, 0.3, 1);
    for (let fate = 0; fate <= fateCount; fate++) {
      pen.strokeStyle = fateColours[fate];
      pen.setLineDash(fate === DELIVERED ? [] : fate === underWay ? [1, 4] : [5, 4]);
      for (let age = 0; age < AGES; age++) {
        let i = near.lineHead[fate * AGES + age];
        if (i < 0) continue;
        pen.globalAlpha = LINE_STRENGTH[age] * strength;
        pen.beginPath();
        for (; i >= 0; i = near.nextLine[i]) line(screenX[near.from[i]], screenY[near.from[i]], screenX[near.to[i]], screenY[near.to[i]]);
        pen.stroke();
      }
    }
    pen.setLineDash([]);
  }
  pen.lineWidth = robots > 1000 ? 1 : 1.8;
  for (let key = 0; key < near.ringHead.length; key++) {
    let i = near.ringHead[key];
    if (i < 0) continue;
    pen.strokeStyle = meta.topic_colours[Math.floor(key / AGES)];
    pen.globalAlpha = LINE_STRENGTH[key % AGES];
    pen.beginPath();
    for (; i >= 0; i = near.nextRing[i]) {
      const size = radius + 2 + near.age[i] / 255 * (robots > 1000 ? 4 : 9);
      const x = screenX[near.sender[i]];
      const y = screenY[near.sender[i]];
      pen.moveTo(x + size, y);
      pen.arc(x, y, size, 0, TURN);
    }
    pen.stroke();
  }
  pen.globalAlpha = 1;
}

/** Adds a dot to the path. So small a circle looks the same with eight corners, and costs less. */
function dot(x, y, radius) {
  if (radius >= 3) {
    pen.moveTo(x + radius, y);
    pen.arc(x, y, radius, 0, TURN);
    return;
  }
  const half = radius * 0.414;
  pen.moveTo(x + radius, y + half);
  pen.lineTo(x + half, y + radius);
  pen.lineTo(x - half, y + radius);
  pen.lineTo(x - radius, y + half);
  pen.lineTo(x - radius, y - half);
  pen.lineTo(x - half, y - radius);
  pen.lineTo(x + half, y - radius);
  pen.lineTo(x + radius, y - half);
}

function drawRobots(radius) {
  for (let role = 0; role < meta.roles.length; role++) {
    if (!roles.shown[role] || roles.counts[role] === 0) continue;
    pen.fillStyle = meta.role_colours[role];
    pen.beginPath();
    for (let robot = 0; robot < robots; robot++) {
      if (roles.value[robot] !== role) continue;
      const x = screenX[robot];
      const y = screenY[robot];
      if (x < -radius || y < -radius || x > view.wide + radius || y > view.high + radius) continue;
      dot(x, y, radius);
    }
    pen.fill();
  }
  drawSigns(radius);
}

// A ring with a gap, as corners: for thousands of robots that is far cheaper than an arc.
const GAPPED = Array.from({ length: 9 }, (_, i) => 0.7 + i / 8 * (TURN - 1.4));
const GAPPED_X = Float64Array.from(GAPPED, Math.cos);
const GAPPED_Y = Float64Array.from(GAPPED, Math.sin);

/** Crosses on the failed robots and rings with a gap around the suspected ones. */
function drawSigns(radius) {
  const many = robots > 600;
  const reach = radius + (many ? 2 : 3);
  const ring = radius + (many ? 2.5 : 4.5);
  pen.strokeStyle = ink;
  pen.lineWidth = many ? 1 / view.dots : 1.6;
  pen.beginPath();
  let signs = 0;
  for (let robot = 0; robot < robots; robot++) {
    if (suspected.value[robot] <= 0 || !roles.shown[roles.value[robot]]) continue;
    const x = screenX[robot];
    const y = screenY[robot];
    if (many) {
      pen.moveTo(x + ring * GAPPED_X[0], y + ring * GAPPED_Y[0]);
      for (let i = 1; i < GAPPED_X.length; i++) pen.lineTo(x + ring * GAPPED_X[i], y + ring * GAPPED_Y[i]);
    } else {
      pen.moveTo(x + ring * GAPPED_X[0], y + ring * GAPPED_Y[0]);
      pen.arc(x, y, ring, 0.7, TURN - 0.7);
    }
    if ((++signs & 63) === 0) { pen.stroke(); pen.beginPath(); }
  }
  pen.stroke();
  // A failed robot counts for more than a suspected one: its cross stays thick.
  pen.lineWidth = 1.6;
  pen.beginPath();
  for (let robot = 0; robot < robots; robot++) {
    if (failed.value[robot] <= 0 || !roles.shown[roles.value[robot]]) continue;
    const x = screenX[robot];
    const y = screenY[robot];
    line(x - reach, y - reach, x + reach, y + reach);
    line(x - reach, y + reach, x + reach, y - reach);
  }
  pen.stroke();
}

/** Words over the picture have a white edge, so that lines under them do not spoil them. */
function label(words, x, y) {
  pen.lineWidth = 3;
  pen.strokeStyle = '#ffffff';
  pen.strokeText(words, x, y);
  pen.fillStyle = ink;
  pen.fillText(words, x, y);
}

function drawFollowed(radius) {
  pen.font = font;
  pen.textBaseline = 'middle';
  if (now.showNumbers) {
    let written = 0;
    for (let robot = 0; robot < robots && written < 300; robot++) {
      const x = screenX[robot];
      const y = screenY[robot];
      if (robot === now.followed || !roles.shown[roles.value[robot]] || x < 0 || y < 0 || x > view.wide || y > view.high) continue;
      label(String(robot), x + radius + 3, y);
      written++;
    }
  }
  if (now.followed < 0) return;
  const x = screenX[now.followed];
  const y = screenY[now.followed];
  // A white edge keeps the ring apart from a crowd.
  pen.beginPath();
  pen.arc(x, y, radius + 8, 0, TURN);
  pen.strokeStyle = '#ffffff';
  pen.lineWidth = 7;
  pen.stroke();
  pen.strokeStyle = ink;
  pen.lineWidth = 3;
  pen.stroke();
  pen.font = 'bold ' + font;
  label(String(now.followed), x + radius + 13 > view.wide - 30 ? x - radius - 40 : x + radius + 13, y);
}

function drawScale() {
  // The longest round length that takes less than a quarter of the width.
  const most = view.wide / 4 / view.scale;
  const power = 10 ** Math.floor(Math.log10(most));
  const length = (most >= 5 * power ? 5 : most >= 2 * power ? 2 : 1) * power;
  const left = 14;
  const base = view.high - 9;
  const width = length * view.scale;
  const unit = length >= 1 ? length + ' m' : Math.round(length * 100) + ' cm';
  pen.font = font;
  pen.textBaseline = 'alphabetic';
  pen.fillStyle = '#ffffffd0';
  pen.fillRect(left - 6, base - 13, width + pen.measureText(unit).width + 18, 20);
  pen.strokeStyle = ink;
  pen.lineWidth = 1.5;
  pen.beginPath();
  pen.moveTo(left, base - 4); pen.lineTo(left, base + 2); pen.lineTo(left + width, base + 2); pen.lineTo(left + width, base - 4);
  pen.stroke();
  pen.fillStyle = ink;
  pen.fillText(unit, left + width + 6, base + 2);
  // The time is part of the picture, so that a saved one still tells its moment.
  const clock = 't = ' + seconds(now.t);
  pen.font = '13px system-ui, sans-serif';
  pen.fillStyle = '#ffffffd0';
  pen.fillRect(8, 5, pen.measureText(clock).width + 12, 22);
  pen.fillStyle = ink;
  pen.fillText(clock, 14, 21);
}

function draw() {
  moveState(now.t);
  if (now.keepCentred && now.followed >= 0) {
    view.x = now.worldX[now.followed];
    view.y = now.worldY[now.followed];
  }
  const { worldX, worldY } = now;
  for (let robot = 0; robot < robots; robot++) {
    screenX[robot] = toScreenX(worldX[robot]);
    screenY[robot] = toScreenY(worldY[robot]);
  }
  const radius = robotRadius();
  pen.setTransform(view.dots, 0, 0, view.dots, 0, 0);
  drawGround();
  drawChains();
  drawLinks();
  drawTrail();
  if (hasMessages && now.showMessages) {
    collectMessages(now.t);
    drawMessages(radius);
  }
  drawRobots(radius);
  drawFollowed(radius);
  drawScale();
  now.drawn++;
}
