// The heading, the environment and the summary tiles.

function isOfSkips(report) {
  return report.rows.some(row => row.skip);
}

function isOfObjects(report) {
  return report.rows.some(row => row.objects);
}

function headline(report) {
  const techniques = techniquesOf(report.rows).length;
  const scenes = unique(report.rows.map(row => row.scene)).length;
  if (isOfSkips(report)) return 'What skipping saves on ' + counted(scenes, 'terrain');
  if (isOfObjects(report)) return 'Buildings as heights and as meshes in ' + counted(scenes, 'city', 'cities');
  return 'Frame time and error of ' + counted(techniques, 'technique') + ' on ' + counted(scenes, 'terrain');
}

function subtitle(report) {
  const sizes = unique(report.rows.map(row => row.size)).map(size => size.replace('x', ' × '));
  const poses = unique(report.rows.map(row => row.pose));
  const frames = report.rows.map(row => row.frames).filter(isNumber);
  const least = Math.min(...frames);
  const most = Math.max(...frames);
  const drawn = !frames.length ? '' : least === most ? ', ' + least + ' frames each' : ', ' + least + ' to ' + most + ' frames each';
  if (isOfObjects(report)) {
    return sizes.join(' and ') + ' pixels' + drawn + '. Every picture is compared with the exact one of the meshes: how far off, wrong, PSNR, SSIM, FLIP. The error in pixels is by the heights of each form itself.';
  }
  return sizes.join(' and ') + ' pixels, ' + (poses.length === 1 ? 'pose ' : 'poses ') + poses.join(', ') + drawn +
    (isOfSkips(report) ? '. Pictures with and without each kind of skipping are compared.' : '. Every picture is compared with the exact one.');
}

function environmentList(environment) {
  const names = {renderer: 'Renderer', gl: 'OpenGL', context: 'Context', cpu: 'Processor', threads: 'Threads', commit: 'Commit', costs: 'Costs for auto'};
  return element('dl', {class: 'environment'}, Object.entries(names)
    .filter(([key]) => environment[key])
    .map(([key, name]) => element('div', {}, element('dt', {}, name), element('dd', {}, String(environment[key])))));
}

function showHeading(report) {
  const suites = unique(report.rows.map(row => row.suite));
  document.title = ['reljef-bench', ...suites].join(' ') + ' – ' + headline(report);
  byId('heading').append(
    element('p', {class: 'overline'}, 'reljef-bench ' + suites.join(', ')),
    element('h1', {}, headline(report)),
    element('p', {class: 'lede'}, subtitle(report)),
    environmentList(report.environment || {}));
  const notices = noticesOf(report);
  if (notices.length) {
    byId('heading').append(element('div', {class: 'notice', role: 'note'}, notices.map(text => element('p', {}, text))));
  }
}

function noticesOf(report) {
  const isCut = report.complete === false && !(report.left_out || []).length;
  return [
    report.stopped || isCut ? 'The run ended early' + (report.stopped ? ': ' + report.stopped : ', these are the rows it had by then') + '.' : '',
    ...(report.notes || []),
  ].filter(Boolean);
}

function tile(name, value, unit, note) {
  return element('div', {class: 'tile'},
    element('p', {class: 'tile-name'}, name),
    element('p', {class: 'tile-value'}, value, unit ? element('span', {class: 'unit'}, ' ' + unit) : null),
    element('p', {class: 'tile-note'}, note));
}

function leastBy(rows, path) {
  return rows.filter(row => isNumber(at(row, path)))
    .reduce((best, row) => (best === null || at(row, path) < at(best, path) ? row : best), null);
}

function measuredTile(report, measured) {
  const noisy = measured.filter(row => row.noisy).length;
  return tile('Rows measured', String(measured.length), 'of ' + report.rows.length, noisy ? noisy + ' noisy' : 'none noisy');
}

function extremeTile(name, row, path, unit, note) {
  return row ? tile(name, figure(at(row, path)), unit, note(row)) : null;
}

function noiseTile(measured) {
  const floors = unique(measured.map(row => row.noise_floor)).filter(isNumber);
  if (!floors.length) return tile('A/A noise floor', '?', '', 'not measured');
  const ends = unique([percent(Math.min(...floors)), percent(Math.max(...floors))]);
  return tile('A/A noise floor', ends.join('–'), '%',
    'how far a technique differs from itself');
}

// How many pictures are the same, and what saves the most and the least of the time.
function skipTiles(report, measured) {
  const rows = measured.filter(row => at(row, 'skip.without'));
  const same = rows.filter(row => !row.skip.difference.pixels && !row.skip.difference.hits).length;
  const share = row => row.skip.saved.ms / (row.ms.median - row.skip.saved.ms);
  const place = row => labelOf(row) + ', ' + titleOf(row);
  const sorted = [...rows].sort((a, b) => share(b) - share(a));
  const shareTile = (name, row) => tile(name, percent(share(row), 0), '%', place(row));
  return [
    measuredTile(report, measured),
    tile('Pictures with the same bits', String(same), 'of ' + rows.length, 'the others are rounded, or marked'),
    ...(sorted.length ? [shareTile('Saves the most time', sorted[0]), shareTile('Saves the least time', sorted[sorted.length - 1])] : []),
    noiseTile(measured),
  ];
}

function showSummary(report) {
  const measured = report.rows.filter(row => isMeasured(row) && !row.null_row);
  if (isOfSkips(report)) {
    byId('summary').append(element('div', {class: 'tiles'}, skipTiles(report, measured)));
    return;
  }
  const place = row => labelOf(row) + ' on ' + viewOf(row);
  const drop = row => isNumber(dropOf(row)) ? '; ' + percent(dropOf(row), 0) + '\u00a0% below texture' : '';
  const shown = measured.filter(row => !showsNothing(row));
  const bounded = shown.filter(row => !unboundedText(row));
  const fastest = leastBy(shown, 'ms.median');
  const slowest = leastBy(shown.map(row => ({...row, slowness: -at(row, 'ms.median')})), 'slowness');
  byId('summary').append(element('div', {class: 'tiles'},
    measuredTile(report, measured),
    extremeTile('Fastest', fastest, 'ms.median', 'ms', place),
    extremeTile('Slowest', slowest, 'ms.median', 'ms', row => place(row) + drop(row)),
    extremeTile('Least RMS error', leastBy(bounded, 'error.reprojection_px.rms'), 'error.reprojection_px.rms', 'px', place),
    noiseTile(measured)));
}

function showFooter(report) {
  byId('footer').append(element('p', {},
    'Written by reljef-bench, schema ' + report.schema + '. The page holds all it shows and fetches nothing. ' +
    'Pictures are shown as JPEG; the figures come from the exact ones.'));
}
