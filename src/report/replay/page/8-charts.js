// The strip of marks over the scrubber, and the charts of the series. Both are drawn once: only their cursors move.

const THUMB = 8; // half the thumb of the scrubber, so that a mark is where the thumb stands
const charts = [];

function sized(canvas, wide, high) {
  const dots = Math.min(devicePixelRatio || 1, 2);
  canvas.width = Math.max(1, Math.round(wide * dots));
  canvas.height = Math.round(high * dots);
  const brush = canvas.getContext('2d');
  brush.scale(dots, dots);
  return brush;
}

function drawStrip() {
  const strip = byId('strip');
  const wide = strip.clientWidth;
  const brush = sized(strip, wide, 22);
  const at = t => THUMB + clamp(t / duration, 0, 1) * (wide - 2 * THUMB);
  brush.fillStyle = '#eeeeee';
  brush.fillRect(THUMB, 13, wide - 2 * THUMB, 8);
  // In a large swarm many faults and suspicions share a column of the screen: its height tells how many.
  const columnsOf = () => new Float64Array(Math.ceil(wide) + 4);
  const failing = columnsOf();
  for (const fault of meta.faults) {
    const from = Math.round(at(fault.from));
    const to = Math.max(from + 2, Math.round(fault.to === null ? at(duration) : at(fault.to)));
    for (let column = from; column < to; column++) failing[column]++;
  }
  const suspicions = columnsOf();
  let done = -1;
  for (const event of meta.events) {
    if (event.kind === 'done') done = event.t;
    if (event.kind === 'suspicion') suspicions[Math.round(at(event.t))]++;
  }
  const bars = (values, colour, base, least, tallest) => {
    const most = values.reduce((a, b) => Math.max(a, b), 1);
    brush.fillStyle = colour;
    values.forEach((value, column) => {
      const height = least + (tallest - least) * value / most;
      if (value > 0) brush.fillRect(column, base - height, 1, height);
    });
  };
  bars(failing, '#e69f00', 21, 2, 8);
  bars(suspicions, ink, 12, 2, 8);
  brush.fillStyle = '#0072b2';
  const end = at(done < 0 ? duration : done);
  brush.beginPath();
  brush.moveTo(end, 0); brush.lineTo(end + 5, 5); brush.lineTo(end, 10); brush.lineTo(end - 5, 5);
  brush.fill();
}

function markWords() {
  const parts = [];
  if (meta.faults.length) parts.push(['mark-fault', count(meta.faults.length, 'fault')]);
  const suspicions = meta.events.filter(event => event.kind === 'suspicion').length;
  if (suspicions) parts.push(['mark-suspicion', count(suspicions, 'suspicion')]);
  parts.push(['mark-done', meta.outcome]);
  for (const [kind, what] of parts) {
    const part = make('span');
    part.append(make('span', undefined, 'mark ' + kind), what);
    byId('marks').append(part);
  }
}

function buildCharts() {
  markWords();
  byId('strip').addEventListener('pointerdown', event => {
    const box = event.target.getBoundingClientRect();
    seek((event.clientX - box.left - THUMB) / (box.width - 2 * THUMB) * duration);
  });
  for (const series of meta.series) {
    const figure = make('figure');
    const caption = make('figcaption');
    const value = make('span', '', 'value');
    caption.append(make('span', words(series.name) + (series.unit ? ' (' + series.unit + ')' : ''), 'name'), value);
    const plot = make('div', undefined, 'plot');
    const canvas = make('canvas');
    canvas.setAttribute('role', 'img');
    const line = make('div', undefined, 'line');
    plot.append(canvas, line);
    figure.append(caption, plot);
    byId('charts').append(figure);
    let low = Infinity;
    let high = -Infinity;
    for (const v of series.v) if (v !== null) { low = Math.min(low, v); high = Math.max(high, v); }
    if (low > high) low = high = 0;
    // From zero, unless zero is far below everything that happened.
    if (low > 0 && low < high * 0.6) low = 0;
    if (low === high) { low -= 0.5; high += 0.5; }
    canvas.setAttribute('aria-label', series.name + ' over time, from ' + short(low) + ' to ' + short(high) + ' ' + series.unit);
    const chart = { series, canvas, line, value, low, high, left: 44, wide: 0, shown: -2 };
    charts.push(chart);
    const jump = event => {
      const box = canvas.getBoundingClientRect();
      seek((event.clientX - box.left - chart.left) / (chart.wide - chart.left - 6) * duration);
    };
    canvas.addEventListener('pointerdown', event => { if (event.button === 0) jump(event); });
    canvas.addEventListener('pointermove', event => { if (event.buttons & 1) jump(event); });
  }
}

/** A number in few signs. */
function short(v) {
  const size = Math.abs(v);
  if (size >= 1e6) return (v / 1e6).toPrecision(3) + ' M';
  if (size >= 1e4) return (v / 1e3).toPrecision(3) + ' k';
  if (size >= 100 || Number.isInteger(v)) return String(Math.round(v));
  return size < 0.001 ? v.toExponential(1) : String(Number(v.toPrecision(3)));
}

function drawCharts() {
  const high = 92;
  for (const chart of charts) {
    const { series, canvas, left } = chart;
    const wide = chart.wide = canvas.clientWidth;
    if (wide === 0) continue;
    const brush = sized(canvas, wide, high);
    const top = 6;
    const base = high - 18;
    const x = t => left + t / duration * (wide - left - 6);
    const y = v => base - (v - chart.low) / (chart.high - chart.low) * (base - top);
    brush.strokeStyle = '#dddddd';
    brush.beginPath();
    for (const v of [chart.low, chart.high]) { brush.moveTo(left, Math.round(y(v)) + 0.5); brush.lineTo(wide - 6, Math.round(y(v)) + 0.5); }
    brush.stroke();
    brush.fillStyle = '#595959';
    brush.font = '11px system-ui, sans-serif';
    brush.textAlign = 'right';
    brush.textBaseline = 'middle';
    brush.fillText(short(chart.low), left - 5, base - 2);
    brush.fillText(short(chart.high), left - 5, top + 3);
    brush.textBaseline = 'top';
    brush.textAlign = 'left';
    brush.fillText('0', left, base + 5);
    brush.textAlign = 'right';
    brush.fillText(Number(duration.toFixed(2)) + ' s', wide - 6, base + 5);
    brush.strokeStyle = ink;
    brush.lineWidth = 1.3;
    brush.lineJoin = 'round';
    brush.beginPath();
    let broken = true;
    // A lone value between two gaps has no line: it gets a dot.
    series.v.forEach((v, i) => {
      if (v === null) { broken = true; return; }
      const place = x(series.t[i]);
      if (!broken) brush.lineTo(place, y(v));
      else if (series.v[i + 1] === null || i + 1 === series.v.length) brush.rect(place - 1, y(v) - 1, 2, 2);
      else brush.moveTo(place, y(v));
      broken = false;
    });
    brush.stroke();
  }
}

/** Moves the cursors of all charts to the moment. */
function moveCursors() {
  for (const chart of charts) {
    const place = chart.left + now.t / duration * (chart.wide - chart.left - 6);
    chart.line.style.transform = 'translateX(' + place.toFixed(1) + 'px)';
    const at = countUntil(chart.series.t, slack(now.t)) - 1;
    if (at === chart.shown) continue;
    chart.shown = at;
    const v = at < 0 ? null : chart.series.v[at];
    setText(chart.value, v === null || v === undefined ? '–' : short(v));
  }
}
