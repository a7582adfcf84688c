// The page of any document with columns: its machine, plots of the suites that have one, and a
// sorted table for each group of rows.

const documents = {
  peers: {title: 'Other programs beside reljef', plot: drawBars(['/ms/median', '/reprojection_px/rms', '/wrong_percent'])},
  flight: {title: 'A flight over streamed terrain', plot: drawPercentiles([['drawing', '/drawing_ms'], ['waiting for tiles', '/waiting_ms']])},
  'lod-growth': {title: 'The same ground with more samples', plot: drawLines('/side', ['/ms/median', '/first_picture_s', '/memory_bytes', '/triangles'])},
  'lod-poses': {title: 'The error bound, checked pixel by pixel', plot: drawLines('/max_error', ['/worst_px', '/ms/median', '/triangles'])},
  'lod-selection': {title: 'Selecting the tiles of a view', plot: drawBars(['/median_ms', '/p99_ms'])},
  'tables-distances': {title: 'Errors over the distance of the eye', plot: drawLines('/distance_m', ['/error/reprojection_px/rms', '/error/wrong_percent', '/error/flip'])},
  'tables-guesses': {title: 'Heights guessed from colours', plot: drawBars(['/error/reprojection_px/rms', '/error/wrong_percent'])},
  'tables-claims': {title: 'Claims of the sources', plot: drawBars(['/ms/median', '/error/reprojection_px/rms', '/objects/bytes'])},
  compare: {title: 'Changes between two runs', folded: ['same', 'untimed']},
};

const megabyte = 1e6;

// The value of a row at "/ms/median", or undefined.
function valueAt(row, key) {
  return at(row, key.slice(1).replaceAll('/', '.'));
}

function columnAt(key) {
  return report.columns.find(column => column.key === key);
}

function columnTitle(column) {
  return withUnit(column.heading, column.unit === 'bytes' ? 'MB' : column.unit);
}

function figureText(value, column) {
  if (value === null || value === undefined) return absent;
  if (typeof value === 'object') return JSON.stringify(value);
  if (!isNumber(value)) return String(value);
  if (column.unit === 'bytes') return signed(value / megabyte);
  return Number.isInteger(value) && Math.abs(value) >= 1 ? (value < 0 ? '−' : '') + grouped(Math.abs(value)) : signed(value);
}

// Rows with equal values of the group columns, in the order of the document.
function groupsOfDocument() {
  const heads = report.columns.filter(column => column.role === 'group');
  const groups = new Map();
  report.rows.forEach((row, index) => {
    const title = heads.map(column => valueAt(row, column.key)).filter(value => value !== null && value !== undefined).join(', ');
    if (!groups.has(title)) groups.set(title, {title, entries: []});
    groups.get(title).entries.push({row, index});
  });
  return [...groups.values()];
}

function nameOfRow(row) {
  const names = report.columns.filter(column => column.role === 'name').map(column => valueAt(row, column.key));
  return names.filter(value => value !== null && value !== undefined).join(', ');
}

function hasValue(column, entries) {
  return entries.some(({row}) => valueAt(row, column.key) !== null && valueAt(row, column.key) !== undefined);
}

function isWords(column, entries) {
  return entries.some(({row}) => ['string', 'object'].includes(typeof valueAt(row, column.key)) && valueAt(row, column.key) !== null);
}

function kindOfCell(column, entries) {
  return [isWords(column, entries) ? 'words' : '', column.detail ? 'detail' : ''].join(' ').trim() || null;
}

function scrolled(id, table) {
  return element('div', {class: 'scroll' + (table.className ? ' ' + table.className : ''), role: 'region', tabindex: '0', 'aria-labelledby': id}, table);
}

// Figures below each other, for a single row.
function listOfFigures(group) {
  const [{row}] = group.entries;
  const columns = report.columns.filter(column => column.role !== 'group' && hasValue(column, group.entries));
  return element('table', {class: 'narrow'}, element('tbody', {}, columns.map(column =>
    element('tr', {class: column.detail ? 'detail' : null}, element('th', {scope: 'row'}, columnTitle(column)),
      element('td', {}, figureText(valueAt(row, column.key), column))))));
}

function tableOfGroup(group) {
  const shown = report.columns.filter(column => column.role !== 'group' && hasValue(column, group.entries));
  const [first, ...others] = shown;
  const columns = shown.map(column => ({...column, title: columnTitle(column), kind: kindOfCell(column, group.entries),
    value: row => valueAt(row, column.key)}));
  const table = {entries: [...group.entries]};
  const cell = (row, column) => element('td', {class: column.kind}, figureText(column.value(row), column));
  table.nodes = new Map(table.entries.map(({row, index}) => [index, element('tr', {'data-row': index},
    element('th', {scope: 'row'}, breakable(figureText(valueAt(row, first.key), first))),
    others.map((column, i) => cell(row, columns[i + 1])))]));
  table.body = element('tbody', {}, [...table.nodes.values()]);
  const heads = columns.map(column => {
    const head = sortableHead(table, column);
    if (column.kind) head.className = column.kind;
    return head;
  });
  table.node = element('table', {}, element('thead', {}, element('tr', {}, heads)), table.body);
  return table.node;
}

function articleOf(group, number, isSingle) {
  const id = 'table-' + number;
  const title = group.title || 'All rows';
  const table = scrolled(id, isSingle ? listOfFigures(group) : tableOfGroup(group));
  const kind = documents[report.suite] || {};
  if ((kind.folded || []).includes(group.title)) {
    return element('details', {class: 'table'}, element('summary', {id}, title + ': ' + counted(group.entries.length, 'row')), table);
  }
  return element('article', {class: 'table'}, element('h3', {id}, title), table);
}

function showDocumentTables() {
  const groups = groupsOfDocument();
  const isSingle = report.rows.length === 1;
  const section = byId('tables');
  const hasDetails = report.columns.some(column => column.detail && hasValue(column, report.rows.map(row => ({row}))));
  const choice = element('input', {type: 'checkbox', id: 'details', onchange: () => section.classList.toggle('all', choice.checked)});
  section.append(...[
    element('h2', {}, 'Tables'),
    isSingle ? null : element('p', {class: 'note'}, 'Click a column name to sort by it; click again to reverse the order.'),
    hasDetails ? element('p', {class: 'controls'}, element('label', {class: 'choice'}, choice, 'Show all columns')) : null,
    ...groups.map((group, number) => articleOf(group, number, isSingle)),
  ].filter(Boolean));
}

function settingsText() {
  const words = Object.entries(report.settings || {})
    .filter(([, value]) => value !== null && value !== false && !(Array.isArray(value) && !value.length))
    .map(([key, value]) => key.replaceAll('_', ' ') + (value === true ? '' : ' ' + (Array.isArray(value) ? value.join(', ') : value)));
  return words.length ? words.join(' · ') : '';
}

// Figures of the whole run. Those of "met" say whether the figure of their name keeps its mark.
function showRun() {
  const summary = report.summary || {};
  const met = summary.met || {};
  const tiles = Object.entries(summary).filter(([, value]) => isNumber(value)).map(([key, value]) => {
    const isBytes = key.endsWith('_bytes');
    const words = key.replace(/_bytes$/, '').replace(/_s$/, '').replaceAll('_', ' ');
    const unit = isBytes ? 'MB' : key.endsWith('_s') ? 's' : '';
    const text = Number.isInteger(value) && !isBytes ? grouped(value) : figure(isBytes ? value / megabyte : value);
    return tile(words[0].toUpperCase() + words.slice(1), text, unit, key in met ? (met[key] ? 'target met' : 'target missed') : '');
  });
  if (tiles.length) byId('summary').append(element('div', {class: tiles.length > 5 ? 'tiles many' : 'tiles'}, tiles));
}

function showDocument() {
  const kind = documents[report.suite] || {title: 'Results of ' + report.suite};
  document.title = 'reljef-bench ' + report.suite + ' – ' + kind.title;
  byId('heading').append(...[
    element('p', {class: 'overline'}, 'reljef-bench ' + report.suite),
    element('h1', {}, kind.title),
    element('p', {class: 'lede'}, settingsText()),
    environmentList(report.environment || {}),
  ]);
  const [stopped] = noticesOf({...report, notes: []});
  if (stopped) byId('heading').append(element('div', {class: 'notice', role: 'note'}, element('p', {}, stopped)));
  (report.notes || []).forEach(note => byId('heading').append(element('p', {class: 'note remark'}, note)));
  showRun();
  if (kind.plot) kind.plot(groupsOfDocument());
  showDocumentTables();
  byId('footer').append(element('p', {}, 'Written by reljef-bench, schema ' + report.schema + '. The page holds all it shows and fetches nothing.'));
  document.documentElement.dataset.ready = 'yes';
}

const report = JSON.parse(byId('report').textContent);
showDocument();
