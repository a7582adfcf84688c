// Plots of documents with columns: bars of figures beside each other, and lines over a figure. Each
// maker takes keys of columns and returns a function that draws the groups of rows.

function plotCard(title, ...content) {
  return element('figure', {class: 'plot'}, element('figcaption', {}, element('h3', {}, title || 'All rows')), ...content);
}

function showPlotSection(title, note, cards) {
  if (!cards.length) return;
  byId('plots').append(element('h2', {}, title), element('p', {class: 'note'}, note), element('div', {class: 'plot-grid'}, cards));
}

// Rows {name, values} with a bar for each value; panels {title, text, longest}.
function barsOf(rows, panels) {
  const bar = (value, panel) => element('div', {class: 'bar-cell'}, isNumber(value)
    ? [element('span', {class: 'stick', '--share': (Math.max(value, 0) / (panel.longest || 1)).toFixed(4)}), element('span', {class: 'bar-value'}, panel.text(value))]
    : element('span', {class: 'bar-value absent'}, absent));
  return element('div', {class: 'bars', role: 'table', '--panels': panels.length},
    element('div', {class: 'bar-row', role: 'row'}, element('span', {class: 'bar-name', role: 'columnheader'}),
      panels.map(panel => element('span', {class: 'bar-title', role: 'columnheader'}, panel.title))),
    rows.map(({name, values}) => element('div', {class: 'bar-row', role: 'row'},
      element('span', {class: 'bar-name', role: 'rowheader'}, breakable(name)), values.map((value, i) => bar(value, panels[i])))));
}

function drawBars(keys) {
  return groups => {
    const cards = groups.map(group => {
      const shown = keys.map(columnAt).filter(column => column && hasValue(column, group.entries));
      const panels = shown.map(column => ({
        title: columnTitle(column), text: value => figureText(value, column),
        longest: Math.max(...group.entries.map(({row}) => valueAt(row, column.key)).filter(isNumber)),
      }));
      const rows = group.entries.map(({row}) => ({name: nameOfRow(row), values: shown.map(column => valueAt(row, column.key))}));
      return panels.length ? plotCard(group.title, barsOf(rows, panels)) : null;
    }).filter(Boolean);
    showPlotSection('At a glance', 'Short bars are better. The scales of bars below each other are the same.', cards);
  };
}

// Median, p95 and p99 of times, on one scale. `series`: their names and keys.
function drawPercentiles(series) {
  return groups => {
    const kinds = ['median', 'p95', 'p99'];
    const cards = groups.map(group => {
      const [{row}] = group.entries;
      const rows = series.map(([name, key]) => ({name, values: kinds.map(kind => valueAt(row, key + '/' + kind))}));
      const longest = Math.max(...rows.flatMap(each => each.values).filter(isNumber));
      return plotCard(group.title, barsOf(rows, kinds.map(kind => ({title: kind + ', ms', text: figure, longest}))));
    });
    showPlotSection('Times of the frames', 'Half of the frames take at most the median, 95 and 99 of a hundred at most p95 and p99.', cards);
  };
}

// The lines of a group: points {time: figure of `across`, error: that of `up`} by the other names.
function linesOfGroup(group, across, up) {
  const names = report.columns.filter(column => column.role === 'name' && column.key !== across && column.key !== '/at');
  const lines = new Map();
  for (const {row} of group.entries) {
    const point = {time: valueAt(row, across), error: valueAt(row, up)};
    if (!(point.time > 0) || !(point.error >= 0) || !isNumber(point.error)) continue;
    const name = names.map(column => valueAt(row, column.key)).filter(Boolean).join(', ');
    if (!lines.has(name)) lines.set(name, []);
    lines.get(name).push(point);
  }
  for (const points of lines.values()) points.sort((a, b) => a.time - b.time);
  return lines;
}

function drawLinesIn(frame, lines, names, titles) {
  const width = Math.round(frame.clientWidth);
  const points = [...lines.values()].flat();
  if (!width || !points.length) return;
  const height = Math.round(Math.min(340, Math.max(240, 0.66 * width)));
  const layout = layoutOf(points, width, height);
  const marks = [...lines].map(([name, line]) => {
    const number = names.indexOf(name);
    const places = line.map(layout.place);
    return svg('g', {class: 'series'},
      svg('path', {class: 'line', d: places.map(([x, y], i) => (i ? 'L' : 'M') + x + ' ' + y).join(''), '--series': seriesColor(number)}),
      places.map(([x, y], i) => svg('g', {transform: `translate(${x} ${y})`}, marker(number),
        svg('title', {}, name + ': ' + tickText(line[i].time) + ', ' + figure(line[i].error)))));
  });
  frame.replaceChildren(svg('svg', {width, height, viewBox: `0 0 ${width} ${height}`, role: 'img', 'aria-label': titles.up + ' over ' + titles.across},
    ...[gridOf(layout), laneOf(layout), axisTitles(layout, titles.across, titles.up), ...marks].filter(Boolean)));
}

function linesCard(group, across, up, names) {
  const column = columnAt(up);
  const scale = column.unit === 'bytes' ? 1 / megabyte : 1;
  const lines = linesOfGroup(group, across, up);
  for (const line of lines.values()) line.forEach(point => { point.error *= scale; });
  if (![...lines.values()].some(line => line.length > 1)) return null;
  const frame = element('div', {class: 'frame'});
  const titles = {across: columnTitle(columnAt(across)), up: columnTitle(column)};
  let drawn = 0;
  new ResizeObserver(() => {
    if (drawn === Math.round(frame.clientWidth)) return;
    drawn = Math.round(frame.clientWidth);
    drawLinesIn(frame, lines, names, titles);
  }).observe(frame);
  return plotCard([group.title, titles.up].filter(Boolean).join(': '), frame);
}

function drawLines(across, ups) {
  return groups => {
    if (!columnAt(across)) return;
    const shown = ups.filter(columnAt);
    const isLine = name => groups.some(group => shown.some(up => (linesOfGroup(group, across, up).get(name) || []).length > 1));
    const names = unique(groups.flatMap(group => shown.flatMap(up => [...linesOfGroup(group, across, up).keys()]))).filter(isLine);
    const cards = groups.flatMap(group => shown.map(up => linesCard(group, across, up, names))).filter(Boolean);
    showPlotSection('At a glance', 'Low is better. Both axes are logarithmic.', cards);
    if (cards.length) byId('plots').querySelector('.plot-grid').before(element('div', {class: 'controls'}, keyOf(names)));
  };
}
