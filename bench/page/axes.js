// Logarithmic axes, markers and keys of plots. Values of exactly zero have a lane of their own.

const margin = {left: 58, right: 18, top: 14, bottom: 42};
const zeroLane = 30;
const shapes = [
  'M-6 0a6 6 0 1 0 12 0a6 6 0 1 0 -12 0z', 'M-5.3 -5.3h10.6v10.6h-10.6z', 'M0 -7.4L7.4 0L0 7.4L-7.4 0z',
  'M0 -7L6.8 5.2H-6.8z', 'M0 7L6.8 -5.2H-6.8z', 'M-2.2 -6.4h4.4v4.2h4.2v4.4h-4.2v4.2h-4.4v-4.2h-4.2v-4.4h4.2z',
  'M-6.6 0L-3.3 -5.8H3.3L6.6 0L3.3 5.8H-3.3z', 'M-4.2 -6.6L0 -3.2L4.2 -6.6L6.6 -4.2L3.2 0L6.6 4.2L4.2 6.6L0 3.2L-4.2 6.6L-6.6 4.2L-3.2 0L-6.6 -4.2z',
];

// Repeated shapes have other colours.
function seriesColor(number) {
  return `var(--series-${(number + 3 * Math.floor(number / shapes.length)) % 8})`;
}

function marker(number) {
  return svg('path', {class: 'marker', d: shapes[number % shapes.length], '--series': seriesColor(number)});
}

// A logarithmic axis that maps values to positions begin..end, with a margin around the values.
function logAxis(values, begin, end) {
  const logs = values.map(Math.log10);
  const low = Math.min(...logs);
  const high = Math.max(...logs);
  const room = Math.max(0.12 * (high - low), (0.7 - (high - low)) / 2, 0.12);
  const from = low - room;
  const to = high + room;
  return {from, to, place: value => begin + (end - begin) * (Math.log10(value) - from) / (to - from)};
}

// Labels 1, 2, 5 of each decade on a short axis, powers of ten on a long one. Minor ticks have no
// label.
function ticksOf(axis) {
  const decades = axis.to - axis.from;
  const step = Math.max(1, Math.ceil(decades / 7));
  const labelled = decades < 0.9 ? [1, 1.5, 2, 3, 4, 5, 6, 7, 8] : decades < 2.6 ? [1, 2, 5] : [1];
  const ticks = [];
  for (let exponent = Math.floor(axis.from); exponent <= Math.ceil(axis.to); ++exponent) {
    for (const digit of [1, 1.5, 2, 3, 4, 5, 6, 7, 8, 9]) {
      const position = exponent + Math.log10(digit);
      const isLabelled = labelled.includes(digit) && exponent % step === 0;
      if (position < axis.from || position > axis.to || (digit === 1.5 && !isLabelled)) continue;
      if (decades > 5 && digit !== 1) continue;
      ticks.push({value: digit * 10 ** exponent, isLabelled});
    }
  }
  return ticks;
}

function tickText(value) {
  if (value >= 1e4 && value < 1e6) return String(Number((value / 1000).toPrecision(2))) + '\u2009k';
  if (value >= 1e6 || value < 0.9e-3) return power(value).replace(/^1\.0·/, '').replace('.0·', '·');
  return String(Number(value.toPrecision(2)));
}

// Axes and positions of the points on a plot of `width` by `height` pixels.
function layoutOf(points, width, height) {
  const errors = points.map(point => point.error).filter(error => error > 0);
  const hasZero = points.some(point => point.error === 0);
  const floor = height - margin.bottom - (hasZero ? zeroLane : 0);
  const x = logAxis(points.map(point => point.time), margin.left, width - margin.right);
  const y = logAxis(errors.length ? errors : [0.1, 1], floor, margin.top);
  const lane = height - margin.bottom - zeroLane / 2 + 3;
  return {width, height, floor, hasZero, lane, x, y, isEmpty: !errors.length,
    place: point => [x.place(point.time), point.error > 0 ? y.place(point.error) : lane]};
}

function gridOf(layout) {
  const {x, y, width, height, floor} = layout;
  const bottom = height - margin.bottom;
  const lines = svg('g', {class: 'grid', 'aria-hidden': 'true'});
  for (const {value, isLabelled} of ticksOf(x)) {
    const place = x.place(value);
    lines.append(svg('line', {class: isLabelled ? 'major' : 'minor', x1: place, x2: place, y1: margin.top, y2: bottom}));
    if (isLabelled) lines.append(svg('text', {x: place, y: bottom + 16, 'text-anchor': 'middle'}, tickText(value)));
  }
  for (const {value, isLabelled} of layout.isEmpty ? [] : ticksOf(y)) {
    const place = y.place(value);
    lines.append(svg('line', {class: isLabelled ? 'major' : 'minor', x1: margin.left, x2: width - margin.right, y1: place, y2: place}));
    if (isLabelled) lines.append(svg('text', {x: margin.left - 8, y: place + 4, 'text-anchor': 'end'}, tickText(value)));
  }
  lines.append(svg('path', {class: 'axis', d: `M${margin.left} ${margin.top}V${floor}M${margin.left} ${bottom}H${width - margin.right}`}));
  return lines;
}

function laneOf(layout) {
  if (!layout.hasZero) return null;
  return svg('g', {class: 'lane', 'aria-hidden': 'true'},
    svg('rect', {x: margin.left, y: layout.floor + 6, width: layout.width - margin.left - margin.right, height: zeroLane - 6}),
    svg('text', {x: margin.left - 8, y: layout.lane + 4, 'text-anchor': 'end'}, '0'));
}

function axisTitles(layout, across, up) {
  const middle = (margin.top + layout.height - margin.bottom) / 2;
  return svg('g', {class: 'axis-titles', 'aria-hidden': 'true'},
    svg('text', {x: (margin.left + layout.width - margin.right) / 2, y: layout.height - 6, 'text-anchor': 'middle'}, across),
    svg('text', {transform: `translate(13 ${middle}) rotate(-90)`, 'text-anchor': 'middle'}, up));
}

function keyOf(techniques) {
  return element('ul', {class: 'key'}, techniques.map((technique, number) =>
    element('li', {}, svg('svg', {width: 16, height: 16, viewBox: '-8 -8 16 16', 'aria-hidden': 'true'}, marker(number)), technique)));
}
