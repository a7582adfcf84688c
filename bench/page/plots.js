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
const maxNames = 14; // with more points, only those of the front are labelled

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
    ...[gridOf(layout), laneOf(layout), axisTitles(layout, 'Median frame time, ms', withUnit(plot.measure.title, plot.measure.unit)), frontLine(plot.points, layout),
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
