// Time against error: one plot for each test, scene and pose, with logarithmic axes and a separate
// lane for errors of exactly zero.

const measures = [
  {path: 'reprojection_px.rms', title: 'Reprojection error, RMS', unit: 'px'},
  {path: 'reprojection_px.median', title: 'Reprojection error, median', unit: 'px'},
  {path: 'reprojection_px.p95', title: 'Reprojection error, p95', unit: 'px'},
  {path: 'reprojection_px.p99', title: 'Reprojection error, p99', unit: 'px'},
  {path: 'reprojection_px.max', title: 'Reprojection error, max', unit: 'px'},
  {path: 'hit_texels.rms', title: 'Hit error, RMS', unit: 'texels'},
  {path: 'wrong_percent', title: 'Wrong surface', unit: '%'},
  {path: 'flip', title: 'FLIP', unit: ''},
  {path: 'rmse', title: 'Picture, RMSE', unit: ''},
];
const frontMeasure = measures[0]; // the error of the report's fronts

const margin = {left: 58, right: 18, top: 14, bottom: 42};
const zeroLane = 30;
const maxNames = 14; // with more points, only those of the front are labelled
const shapes = [
  'M-6 0a6 6 0 1 0 12 0a6 6 0 1 0 -12 0z', 'M-5.3 -5.3h10.6v10.6h-10.6z', 'M0 -7.4L7.4 0L0 7.4L-7.4 0z',
  'M0 -7L6.8 5.2H-6.8z', 'M0 7L6.8 -5.2H-6.8z', 'M-2.2 -6.4h4.4v4.2h4.2v4.4h-4.2v4.2h-4.4v-4.2h-4.2v-4.4h4.2z',
  'M-6.6 0L-3.3 -5.8H3.3L6.6 0L3.3 5.8H-3.3z', 'M-4.2 -6.6L0 -3.2L4.2 -6.6L6.6 -4.2L3.2 0L6.6 4.2L4.2 6.6L0 3.2L-4.2 6.6L-6.6 4.2L-3.2 0L-6.6 -4.2z',
];

function marker(number) {
  const color = (number + 3 * Math.floor(number / shapes.length)) % 8; // repeated shapes have other colours
  return svg('path', {class: 'marker', d: shapes[number % shapes.length], '--series': `var(--series-${color})`});
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
  if (value >= 1e5 || value < 0.9e-3) return power(value).replace(/^1\.0·/, '').replace('.0·', '·');
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

function axisTitles(layout, measure) {
  const title = measure.title + (measure.unit ? ', ' + measure.unit : '');
  const middle = (margin.top + layout.height - margin.bottom) / 2;
  return svg('g', {class: 'axis-titles', 'aria-hidden': 'true'},
    svg('text', {x: (margin.left + layout.width - margin.right) / 2, y: layout.height - 6, 'text-anchor': 'middle'}, 'Median frame time, ms'),
    svg('text', {transform: `translate(13 ${middle}) rotate(-90)`, 'text-anchor': 'middle'}, title));
}

// Steps: between two settings of the front, the left one is the most accurate.
function frontLine(points, layout) {
  const sorted = points.filter(point => point.isOnFront).sort((a, b) => a.time - b.time);
  const front = sorted.filter((point, i) => sorted.slice(0, i).every(other => other.error > point.error));
  if (!front.length) return null;
  const places = front.map(layout.place);
  const steps = places.map(([x, y], i) => (i ? `H${x}V${y}` : `M${x} ${margin.top}V${y}`)).join('');
  return svg('path', {class: 'front', d: `${steps}H${layout.width - margin.right}`, 'aria-hidden': 'true'});
}

function pointNode(point, layout, plot) {
  const [x, y] = layout.place(point);
  const [low, high] = at(point.row, 'ms.interval') || [point.time, point.time];
  return svg('g', {
    class: ['point', point.isOnFront ? 'on-front' : '', point.isDominated ? 'dominated' : '', point.row.noisy ? 'noisy' : ''].join(' ').trim(),
    role: byId('row-' + point.index) ? 'link' : 'img', tabindex: '-1', 'data-row': point.index, 'aria-label': summaryOf(point, plot.measure).join(', '),
    onpointerenter: () => showTip(plot, point), onpointerleave: () => hideTip(plot),
    onfocus: () => showTip(plot, point), onblur: () => hideTip(plot),
    onclick: () => goToPictures(point), onkeydown: event => moveOn(event, plot, point),
  },
  svg('line', {class: 'interval', x1: layout.x.place(low), x2: layout.x.place(high), y1: y, y2: y}),
  svg('g', {transform: `translate(${x} ${y})`}, svg('circle', {class: 'target', r: 14}), svg('circle', {class: 'ring', r: 11}), marker(point.series)));
}

function summaryOf(point, measure) {
  const {row, error} = point;
  const [low, high] = at(row, 'ms.interval') || [];
  const lines = [
    labelOf(row),
    figure(point.time) + ' ms' + (isNumber(low) ? ' (' + figure(low) + '–' + figure(high) + ')' : ''),
    measure.title + ': ' + (error === 0 ? 'exactly 0' : figure(error) + (measure.unit ? ' ' + measure.unit : '')) + point.beyond,
  ];
  if (isNumber(row.ratio_to_texture)) lines.push(fixed(row.ratio_to_texture, 2) + ' × texture');
  if (point.isOnFront) lines.push('on the Pareto front');
  if (point.dominatedBy) lines.push('dominated by ' + point.dominatedBy);
  if (row.noisy) lines.push('noisy: ' + noiseOf(row));
  return lines;
}

function showTip(plot, point) {
  const [x, y] = plot.layout.place(point);
  const [name, ...rest] = summaryOf(point, plot.measure);
  plot.tip.replaceChildren(element('strong', {}, name), ...rest.map(line => element('span', {}, line)));
  plot.tip.hidden = false;
  const left = Math.min(Math.max(x - plot.tip.offsetWidth / 2, 0), plot.layout.width - plot.tip.offsetWidth);
  const above = y - plot.tip.offsetHeight - 16;
  plot.tip.style.left = left + 'px';
  plot.tip.style.top = (above >= 0 ? above : y + 18) + 'px';
}

function hideTip(plot) {
  plot.tip.hidden = true;
}

function goToPictures(point) {
  if (byId('row-' + point.index)) location.hash = '#row-' + point.index;
}

// The Tab key stops once per plot; arrow keys move between points by time.
function moveOn(event, plot, point) {
  const steps = {ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1};
  if (event.key === 'Escape') hideTip(plot);
  if (event.key === 'Enter') goToPictures(point);
  if (!(event.key in steps)) return;
  event.preventDefault();
  const count = plot.points.length;
  const next = plot.points[(plot.points.indexOf(point) + steps[event.key] + count) % count];
  plot.nodes.forEach(node => node.setAttribute('tabindex', '-1'));
  const node = plot.nodes.get(next.index);
  node.setAttribute('tabindex', '0');
  node.focus();
}

// Labels beside the points that cover neither each other nor a point.
function namesOf(points, layout) {
  const taken = points.map(layout.place).map(([x, y]) => [x - 8, y - 8, x + 8, y + 8]);
  const isFree = box => box[0] >= margin.left && box[2] <= layout.width - 4 && box[1] >= 0 && box[3] <= layout.height - margin.bottom + 2 &&
    taken.every(other => box[2] < other[0] || box[0] > other[2] || box[3] < other[1] || box[1] > other[3]);
  const names = svg('g', {class: 'names', 'aria-hidden': 'true'});
  for (const point of points.filter(point => points.length <= maxNames || point.isOnFront)) {
    const [x, y] = layout.place(point);
    const text = labelOf(point.row) + point.beyond;
    const width = 6.9 * text.length;
    const beside = point.isOnFront ? [['start', x + 11, y - 9, x + 11]] : []; // off the front's line
    const choices = [...beside, ['start', x + 12, y + 4, x + 12], ['end', x - 12, y + 4, x - 12 - width],
      ['middle', x, y - 13, x - width / 2], ['middle', x, y + 21, x - width / 2]];
    const choice = choices.find(([, , base, left]) => isFree([left, base - 11, left + width, base + 3]));
    if (!choice) continue;
    const [anchor, place, base, left] = choice;
    taken.push([left, base - 11, left + width, base + 3]);
    names.append(svg('text', {x: place, y: base, 'text-anchor': anchor}, text));
  }
  return names;
}

function drawPlot(plot) {
  const width = Math.round(plot.frame.clientWidth);
  if (!plot.points.length || !width) return;
  const height = Math.round(Math.min(420, Math.max(300, 0.66 * width)));
  const layout = layoutOf(plot.points, width, height);
  plot.layout = layout;
  plot.nodes = new Map(plot.points.map(point => [point.index, pointNode(point, layout, plot)]));
  plot.nodes.get(plot.points[0].index).setAttribute('tabindex', '0');
  const drawing = svg('svg', {width, height, viewBox: `0 0 ${width} ${height}`, role: 'group', 'aria-label': plot.group.title + ': time against error'},
    ...[gridOf(layout), laneOf(layout), axisTitles(layout, plot.measure), frontLine(plot.points, layout),
      namesOf(plot.points, layout), svg('g', {class: 'points'}, [...plot.nodes.values()])].filter(Boolean));
  hideTip(plot);
  plot.frame.replaceChildren(drawing, plot.tip);
}

function pointsOf(plot, techniques) {
  const front = plot.measure === frontMeasure ? plot.front : undefined;
  const dominated = new Map((front && front.dominated || []).map(({label, by}) => [label, by]));
  return plot.group.rows
    .map(({row, index}) => ({
      row, index, time: at(row, 'ms.median'), error: at(row, 'error.' + plot.measure.path),
      beyond: plot.measure.path.startsWith('reprojection_px') ? unboundedText(row) : '',
      series: techniques.indexOf(row.technique),
      isOnFront: Boolean(front && (front.front || []).includes(labelOf(row))),
      isDominated: dominated.has(labelOf(row)), dominatedBy: dominated.get(labelOf(row)),
    }))
    .filter(point => !point.row.null_row && point.time > 0 && isNumber(point.error) && point.error >= 0)
    .sort((a, b) => a.time - b.time);
}

function show(plot, measure, techniques) {
  plot.measure = measure;
  plot.points = pointsOf(plot, techniques);
  plot.frame.replaceChildren(plot.points.length ? plot.tip
    : element('p', {class: 'note'}, 'No row of this table has that error.'));
  drawPlot(plot);
}

function frontNote(front) {
  if (!front) return null;
  const dominated = front.dominated || [];
  return element('div', {class: 'front-note'},
    element('p', {class: 'note'}, 'Pareto front: ' + (front.front || []).join(' → ') +
      (isNumber(front.area) ? '. Area under it: ' + figure(front.area) : '. No area: a technique or the ratio to texture is lacking') + '.'),
    (front.holed || []).length ? element('p', {class: 'note'}, 'No place on it, for holes over 0.1 % of the picture: ' + front.holed.join(', ') + '.') : null,
    dominated.length ? element('details', {}, element('summary', {}, counted(dominated.length, 'dominated setting')),
      element('ul', {}, dominated.map(({label, by}) => element('li', {}, label + ' by ' + by)))) : null);
}

function plotOf(group, report) {
  const plot = {
    group, points: [], frame: element('div', {class: 'frame'}),
    tip: element('div', {class: 'tip', role: 'status', hidden: true}),
    front: (report.fronts || []).find(front => front.scene === group.scene && front.pose === group.pose),
  };
  plot.node = element('figure', {class: 'plot'},
    element('figcaption', {}, element('h3', {}, group.title)), plot.frame, frontNote(plot.front));
  new ResizeObserver(() => {
    if (plot.layout && plot.layout.width !== Math.round(plot.frame.clientWidth)) drawPlot(plot);
  }).observe(plot.frame);
  return plot;
}

function keyOf(techniques) {
  return element('ul', {class: 'key'}, techniques.map((technique, number) =>
    element('li', {}, svg('svg', {width: 16, height: 16, viewBox: '-8 -8 16 16', 'aria-hidden': 'true'}, marker(number)), technique)));
}

function showPlots(report) {
  if (isOfSkips(report)) return; // all of its pictures are the same
  const techniques = techniquesOf(report.rows);
  const groups = groupsOf(report.rows).filter(group => group.rows.some(({row}) => isMeasured(row) && row.error));
  if (!groups.length) return;
  const plots = groups.map(group => plotOf(group, report));
  const choice = element('select', {id: 'measure', onchange: () => plots.forEach(plot => show(plot, measures[choice.selectedIndex], techniques))},
    measures.map(measure => element('option', {}, measure.title)));
  byId('plots').append(
    element('h2', {}, 'Time against error'),
    element('p', {class: 'note'}, 'Left and below is better. Both axes are logarithmic; errors of exactly zero are in the lane below. ' +
      'Point at a mark, or select it with the Tab and arrow keys, to see its setting.'),
    element('div', {class: 'controls'}, element('label', {for: 'measure'}, 'Error'), choice, keyOf(techniques)),
    element('div', {class: 'plot-grid'}, plots.map(plot => plot.node)));
  plots.forEach(plot => show(plot, measures[0], techniques));
}
