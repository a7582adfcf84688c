// One table for each test, scene and pose.

const columns = [
  {group: 'Frame time', title: 'median ms', value: row => at(row, 'ms.median'), cell: timeCell},
  {group: 'Frame time', title: 'p95', value: row => at(row, 'ms.p95'), text: figure},
  {group: 'Frame time', title: 'FPS', value: row => row.fps, text: figure},
  {group: 'Frame time', title: '1 % low', value: row => row.fps_1_percent_low, text: figure},
  {group: 'Frame time', title: '× texture', value: row => row.ratio_to_texture, text: value => fixed(value, 2)},
  {group: 'Frame time', title: 'drop %', value: dropOf, text: percent},
  {group: 'Sources', title: 'FPS', value: row => at(row, 'source.fps'), cell: sourceCell},
  {group: 'Sources', title: '× texture', value: row => at(row, 'source.ratio'), text: value => fixed(value, 2)},
  {group: 'Reprojection error, px', title: 'RMS', value: row => at(row, 'error.reprojection_px.rms'), cell: row => unboundedCell(row, 'rms')},
  {group: 'Reprojection error, px', title: 'median', value: row => at(row, 'error.reprojection_px.median'), text: figure},
  {group: 'Reprojection error, px', title: 'p95', value: row => at(row, 'error.reprojection_px.p95'), text: figure},
  {group: 'Reprojection error, px', title: 'p99', value: row => at(row, 'error.reprojection_px.p99'), text: figure},
  {group: 'Reprojection error, px', title: 'max', value: row => at(row, 'error.reprojection_px.max'), cell: row => unboundedCell(row, 'max')},
  {group: 'Off the meshes', title: 'samples', value: row => (row.objects ? at(row, 'error.hit_texels.rms') : undefined), text: figure},
  {group: 'Surface', title: 'wrong %', value: row => at(row, 'error.wrong_percent'), text: figure},
  {group: 'Surface', title: 'holes', value: row => at(row, 'error.holes'), text: grouped},
  {group: 'Picture', title: 'PSNR dB', value: psnrOf, cell: psnrCell},
  {group: 'Picture', title: 'SSIM', value: row => at(row, 'error.ssim'), text: value => fixed(value, 3)},
  {group: 'Picture', title: 'FLIP', value: row => at(row, 'error.flip'), text: figure},
  {group: 'Skipping it saves', title: 'ms', value: savingOf('ms'), text: signed},
  {group: 'Skipping it saves', title: 'taps a pixel', value: row => perPixel(row, savingOf('taps')(row)), text: signed},
  {group: 'Skipping it saves', title: 'rays', value: savingOf('rays'), text: grouped},
  {group: 'Skipping it saves', title: 'triangles', value: savingOf('triangles'), text: grouped},
  {group: 'Skipping it saves', title: 'kB uploaded', value: row => thousandth(savingOf('bytes_uploaded')(row)), text: grouped},
  {group: 'Skipping it saves', title: 'kB read', value: row => thousandth(savingOf('bytes_read')(row)), text: grouped},
  {group: 'Skipping it saves', title: 'picture', value: row => at(row, 'skip.difference.hits'), cell: samenessCell},
  {group: 'Work of a pixel', title: 'taps', value: row => row.taps, text: figure},
  {group: 'Work of a pixel', title: 'steps', value: row => perPixel(row, at(row, 'work.steps')), text: figure},
  {group: 'Work of a pixel', title: 'rays', value: row => perPixel(row, at(row, 'work.rays')), text: figure},
  {group: 'Run', title: 'MB sent', value: row => (row.objects ? row.objects.bytes / 1e6 : undefined), text: figure},
  {group: 'Run', title: 'triangles', value: row => row.triangles, text: grouped},
  {group: 'Run', title: 'noise %', value: row => row.noise_floor, text: percent},
];

// What a kind of skipping saves; nothing for the row that skips everything.
function savingOf(key) {
  return row => (at(row, 'skip.without') ? at(row, 'skip.saved.' + key) : undefined);
}

function thousandth(value) {
  return isNumber(value) ? value / 1000 : undefined;
}

function perPixel(row, count) {
  if (!isNumber(count) || !row.size) return undefined;
  const [width, height] = row.size.split('x').map(Number);
  return count / (width * height);
}

function samenessCell(row) {
  if (!at(row, 'skip.without')) return absent;
  const found = row.skip.difference;
  if (!found.pixels && !found.hits) return 'same bits';
  const text = (found.hits ? found.max_px <= found.tolerance_px : found.levels <= found.tolerance_levels) ? 'rounded' : 'another';
  return element('span', {title: grouped(found.pixels) + ' pixels by up to ' + found.levels + ' of 255; ' + grouped(found.hits) +
    ' hits, ' + figure(found.max_px) + ' px from their pixels, ' + figure(found.tolerance_px) + ' are allowed'}, text);
}

// Infinite for identical pictures.
function psnrOf(row) {
  if (!row.error || row.error.psnr === undefined) return undefined;
  return row.error.psnr === null ? Infinity : row.error.psnr;
}

function psnrCell(row) {
  const psnr = psnrOf(row);
  return psnr === Infinity ? element('span', {title: 'the same picture'}, '∞') : fixed(psnr, 1);
}

// The median and a bar of its length with the interval.
function timeCell(row, table) {
  if (!isMeasured(row)) return absent;
  const interval = at(row, 'ms.interval');
  const [low, high] = interval || [row.ms.median, row.ms.median];
  const share = value => (100 * value / table.longest).toFixed(2) + '%';
  const name = 'median ' + figure(row.ms.median) + ' ms, ' +
    (interval ? '95 % interval ' + figure(low) + ' to ' + figure(high) + ' ms' : 'too few frames for an interval');
  return element('span', {class: 'time', title: name},
    figure(row.ms.median),
    element('span', {class: 'bar', role: 'img', 'aria-label': name, '--length': share(row.ms.median)},
      element('span', {class: 'interval', '--low': share(low), '--span': share(high - low)})));
}

function sourceCell(row) {
  const fps = at(row, 'source.fps');
  return isNumber(fps) ? element('span', {title: row.source.where || ''}, figure(fps)) : absent;
}

function unboundedCell(row, key) {
  const unbounded = at(row, 'error.reprojection_px.unbounded');
  const text = figure(at(row, 'error.reprojection_px.' + key));
  if (!unbounded) return text;
  return element('span', {title: counted(unbounded, 'pixel') + ' without a bound, not in the figures'},
    text, element('span', {class: 'beyond'}, unboundedText(row)));
}

function tag(text, kind, title) {
  return element('span', {class: 'tag ' + kind, title}, text);
}

function noiseOf(row) {
  return isNumber(row.noise_floor) ? 'The noise floor is ' + percent(row.noise_floor) + ' %.' : 'Too few frames: ' + row.frames + '.';
}

function unprovenOf(row) {
  const search = row.choice && row.choice.typical;
  return search && 'Drawn by ' + search.technique + ', which shows ' + percent(search.share) + ' % of the probes within the bound.';
}

function tagsOf(row) {
  return [
    row.null_row ? tag('A/A', 'again', 'The same technique once more: the noise floor.') : null,
    row.noisy ? tag('noisy', 'noisy', noiseOf(row)) : null,
    unprovenOf(row) ? tag('unproven', 'noisy', unprovenOf(row)) : null,
  ];
}

function nameCell({row, index}) {
  const name = breakable(labelOf(row) + (row.null_row ? ', again' : ''));
  const shown = byId('row-' + index);
  return element('th', {scope: 'row'},
    shown ? element('a', {href: '#row-' + index, title: 'to its pictures'}, name) : name, ' ', tagsOf(row));
}

function dataCell(column, row, table) {
  const content = column.cell ? column.cell(row, table) : column.text(column.value(row));
  return element('td', {class: content === absent ? 'absent' : null}, content);
}

function bodyRow(entry, table) {
  const kinds = ['noisy', 'null_row'].filter(kind => entry.row[kind]);
  return element('tr', {class: kinds.join(' ') || null, 'data-row': entry.index},
    nameCell(entry), table.columns.map(column => dataCell(column, entry.row, table)));
}

function groupHeads(table) {
  const heads = [element('td', {})];
  for (const name of unique(table.columns.map(column => column.group))) {
    const span = table.columns.filter(column => column.group === name).length;
    heads.push(element('th', {scope: 'colgroup', colspan: span}, name));
  }
  return heads;
}

function tableHead(table) {
  const technique = {title: 'technique', value: row => labelOf(row)};
  return element('thead', {},
    element('tr', {class: 'groups'}, groupHeads(table)),
    element('tr', {}, sortableHead(table, technique), table.columns.map(column => sortableHead(table, column))));
}

function isShown(column, entries) {
  const hasSkips = entries.some(({row}) => row.skip);
  if (column.group === 'Sources') return entries.some(({row}) => row.source);
  if (column.group === 'Skipping it saves') return hasSkips;
  if (column.group === 'Work of a pixel') return entries.some(({row}) => row.work);
  return !hasSkips || ['Frame time', 'Run'].includes(column.group) && !['× texture', 'drop %', 'FPS', '1 % low'].includes(column.title);
}

function tableOf(group) {
  const rows = group.rows.map(entry => entry.row);
  const table = {
    entries: [...group.rows],
    columns: columns.filter(column => isShown(column, group.rows)),
    longest: Math.max(...rows.filter(isMeasured).map(row => (at(row, 'ms.interval') || [0, row.ms.median])[1]), 1e-9),
  };
  table.nodes = new Map(table.entries.map(entry => [entry.index, bodyRow(entry, table)]));
  table.body = element('tbody', {}, [...table.nodes.values()]);
  table.node = element('table', {}, tableHead(table), table.body);
  return table.node;
}

function sourcesOf(group) {
  const places = unique(group.rows.map(({row}) => at(row, 'source.where')));
  return places.length ? element('p', {class: 'note'}, 'Sources: ' + places.join('; ') + '.') : null;
}

// The kinds of skipping, and the errors of the picture that all of its rows show.
function kindsOf(group) {
  const kinds = group.rows.map(({row}) => row.skip).filter(skip => skip && skip.without);
  return kinds.length ? element('p', {class: 'note'}, kinds.map(skip => skip.without + ': ' + skip.meaning).join('; ') + '.') : null;
}

// The smallest errors that pictures can have here: those of exact.
function floorOf(group) {
  const exact = group.rows.find(({row}) => row.technique === 'exact' && row.error);
  if (!exact) return null;
  const {row} = exact;
  return element('p', {class: 'note floor'}, 'Floor of the pictures’ errors, that of exact: PSNR ' +
    (psnrOf(row) === Infinity ? '∞' : fixed(psnrOf(row), 1)) + ' dB, SSIM ' + fixed(row.error.ssim, 3) + ', FLIP ' + figure(row.error.flip) + '.');
}

function showTables(report) {
  const section = byId('tables');
  section.append(element('h2', {}, 'Tables'),
    element('p', {class: 'note'}, 'Click a column name to sort by it; click again to reverse the order. ' +
      'The bar is the median, the mark on it its 95 % interval.'));
  groupsOf(report.rows).forEach((group, number) => {
    const id = 'table-' + number;
    section.append(element('article', {class: 'table'},
      element('h3', {id}, group.title),
      element('div', {class: 'scroll', role: 'region', tabindex: '0', 'aria-labelledby': id}, tableOf(group)),
      sourcesOf(group), kindsOf(group), floorOf(group)));
  });
}
