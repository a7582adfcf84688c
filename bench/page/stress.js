// The report of the suite stress: a line for each stress and figure, plots of the errors of grazing
// views, and all rows.

const report = JSON.parse(byId('report').textContent);
const order = ['OVER', 'known', 'reported', 'ok'];
const verdictWords = {OVER: 'over its limit', known: 'known', reported: 'reported', ok: 'ok'};

function valueText(row) {
  if (row.value === null) return 'not a number';
  return row.value === 0 ? '0' : figure(row.value);
}

function limitText(row) {
  return row.limit === null ? absent : row.limit === 0 ? '0' : figure(row.limit);
}

function placeText(row) {
  return [row.terrain, row.technique, row.at].filter(Boolean).join(', ');
}

// Rows of the same stress and figure, with the worst of them.
function linesOf(rows) {
  const lines = new Map();
  for (const row of rows) {
    const key = [row.stress, row.figure, row.limit].join('\n');
    if (!lines.has(key)) lines.set(key, {worst: row, rows: []});
    const line = lines.get(key);
    line.rows.push(row);
    if (row.value === null || (line.worst.value !== null && row.value > line.worst.value)) line.worst = row;
  }
  return [...lines.values()];
}

function worstVerdict(rows) {
  return order.find(verdict => rows.some(row => row.verdict === verdict));
}

function verdictTag(verdict) {
  const isBad = verdict === 'OVER' || verdict === 'known';
  return element('span', {class: 'tag ' + (isBad ? 'noisy' : 'again')}, verdictWords[verdict]);
}

// A column of numbers, or of words, which are on the left and may take several lines.
function number(head, cell) {
  return {head, cell, kind: null};
}

function words(head, cell) {
  return {head, cell, kind: 'words'};
}

const lineColumns = [
  words('figure', line => line.worst.figure),
  number('rows', line => String(line.rows.length)),
  number('worst', line => valueText(line.worst)),
  number('limit', line => limitText(line.worst)),
  number('verdict', line => verdictTag(worstVerdict(line.rows))),
  words('worst at', line => placeText(line.worst)),
];

const rowColumns = [
  words('terrain', row => row.terrain || absent),
  words('technique', row => row.technique || absent),
  words('figure', row => row.figure),
  number('value', valueText),
  number('limit', limitText),
  number('verdict', row => verdictTag(row.verdict)),
  words('worst at', row => row.at || absent),
  words('known', row => row.known || absent),
];

function tableOf(columns, rows, stressOf) {
  return element('div', {class: 'table'}, element('div', {class: 'scroll', role: 'region', tabindex: '0'},
    element('table', {},
      element('thead', {}, element('tr', {class: 'plain'}, element('th', {scope: 'col'}, 'stress'),
        columns.map(column => element('th', {scope: 'col', class: column.kind}, column.head)))),
      element('tbody', {}, rows.map(row => element('tr', {}, element('th', {scope: 'row'}, stressOf(row)),
        columns.map(column => element('td', {class: column.kind}, column.cell(row)))))))));
}

function countTile(name, count, note) {
  return element('div', {class: 'tile'},
    element('p', {class: 'tile-name'}, name),
    element('p', {class: 'tile-value'}, String(count)),
    element('p', {class: 'tile-note'}, note));
}

function showHead() {
  byId('heading').append(
    element('p', {class: 'overline'}, 'reljef-bench stress'),
    element('h1', {}, 'Numerical stability'),
    element('p', {class: 'lede'}, report.settings.size.replace('x', ' × ') + ' pixels' + (report.settings.quick ? ', quick' : '') +
      '. Every figure is the worst of its cases.'),
    environmentList(report.environment));
  if (report.stopped) {
    byId('heading').append(element('div', {class: 'notice', role: 'note'}, element('p', {}, 'The run ended early: ' + report.stopped + '.')));
  }
  const count = verdict => report.rows.filter(row => row.verdict === verdict).length;
  byId('summary').append(element('div', {class: 'tiles'},
    countTile('Within the limit', count('ok'), 'of ' + (report.rows.length - count('reported')) + ' figures with a limit'),
    countTile('Over the limit', count('OVER'), 'none is allowed'),
    countTile('Known', count('known'), 'over the limit today'),
    countTile('Reported', count('reported'), 'without a limit')));
}

// Grazing views: the share of wrong pixels by elevation, a line for each technique.
const plotBox = {width: 560, height: 340, left: 54, right: 150, top: 14, bottom: 44};
const leastShare = 0.01; // percent; smaller ones lie on the axis

function curvesOf(rows) {
  const curves = new Map();
  for (const row of rows) {
    const elevation = parseFloat(row.at);
    if (!isNumber(elevation) || !isNumber(row.value)) continue;
    if (!curves.has(row.technique)) curves.set(row.technique, []);
    curves.get(row.technique).push({elevation, share: row.value});
  }
  return [...curves].map(([technique, points]) => ({technique, points}));
}

function shortName(technique) {
  return technique.startsWith('polygons') ? technique : technique.split(':')[0];
}

function plotOf(terrain, rows) {
  const {width, height, left, right, top, bottom} = plotBox;
  const x = elevation => left + (width - left - right) * (Math.log10(90) - Math.log10(elevation)) / (Math.log10(90) + 2);
  const y = share => height - bottom - (height - top - bottom) * (Math.log10(Math.max(share, leastShare)) + 2) / 4;
  const curves = curvesOf(rows);
  const grid = [0.01, 0.1, 1, 10, 100].flatMap(share => [
    svg('line', {class: 'major', x1: left, x2: width - right, y1: y(share), y2: y(share)}),
    svg('text', {x: left - 8, y: y(share) + 4, 'text-anchor': 'end'}, share === leastShare ? '≤ ' + share : String(share))]);
  grid.push(...[90, 45, 10, 1, 0.1, 0.01].map(elevation =>
    svg('text', {x: x(elevation), y: height - bottom + 18, 'text-anchor': 'middle'}, String(elevation))));
  const last = curves.map(curve => ({curve, y: y(curve.points.at(-1).share)})).sort((a, b) => a.y - b.y);
  last.forEach((label, i) => { label.y = i ? Math.max(label.y, last[i - 1].y + 13) : label.y; });
  const overflow = last.length ? Math.max(0, last.at(-1).y - (height - bottom)) : 0;
  last.forEach(label => { label.y -= overflow; });
  return element('figure', {class: 'plot'},
    element('figcaption', {}, element('h3', {}, terrain)),
    element('div', {class: 'frame'}, svg('svg', {viewBox: `0 0 ${width} ${height}`, width: '100%', role: 'img', 'aria-label': 'wrong pixels by elevation'},
      svg('g', {class: 'grid'}, grid),
      svg('text', {x: (left + width - right) / 2, y: height - 8, 'text-anchor': 'middle'}, 'elevation of the view, degrees'),
      svg('text', {transform: `translate(13 ${(top + height - bottom) / 2}) rotate(-90)`, 'text-anchor': 'middle'}, 'wrong pixels, %'),
      curves.map((curve, i) => svg('path', {
        d: curve.points.map((point, k) => (k ? 'L' : 'M') + x(point.elevation) + ' ' + y(point.share)).join(''),
        fill: 'none', 'stroke-width': 1.75, style: `stroke: var(--series-${i % 8})`, 'stroke-dasharray': i < 8 ? null : '5 3'},
        svg('title', {}, curve.technique))),
      last.map(({curve, y: place}) => svg('text', {x: width - right + 8, y: place + 4, style: `fill: var(--series-${curves.indexOf(curve) % 8})`}, shortName(curve.technique))))));
}

function showGrazing() {
  const rows = report.rows.filter(row => row.stress === 'grazing view' && row.figure === '% of pixels wrong');
  if (!rows.length) return;
  const terrains = [...new Set(rows.map(row => row.terrain))];
  byId('plots').append(
    element('h2', {}, 'Grazing views'),
    element('p', {class: 'note'}, 'The share of wrong pixels as the view sinks from straight down to the ground.'),
    element('div', {class: 'plot-grid'}, terrains.map(terrain => plotOf(terrain, rows.filter(row => row.terrain === terrain)))));
}

function showRows() {
  const byVerdict = (a, b) => order.indexOf(a) - order.indexOf(b);
  const sorted = [...report.rows].sort((a, b) => byVerdict(a.verdict, b.verdict));
  const exceptional = sorted.filter(row => row.verdict === 'OVER' || row.verdict === 'known');
  if (exceptional.length) {
    byId('tables').append(element('h2', {}, 'Over a limit'), tableOf(rowColumns, exceptional, row => row.stress));
  }
  byId('tables').append(
    element('h2', {class: 'next'}, 'Figures'),
    element('p', {class: 'note'}, 'The worst row of each stress and figure.'),
    tableOf(lineColumns, linesOf(report.rows), line => line.worst.stress),
    element('details', {class: 'next'}, element('summary', {}, 'All ' + counted(report.rows.length, 'row')),
      tableOf(rowColumns, sorted, row => row.stress)));
  byId('footer').append(element('p', {}, 'reljef-bench stress, ' + counted(report.rows.length, 'figure')));
}

showHead();
showGrazing();
showRows();
document.documentElement.dataset.ready = 'yes';
