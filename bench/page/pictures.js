// The picture, the truth and the error of each row, with a slider to compare two of them.

function rampOf(colors, low, high, unit) {
  const ramp = 'linear-gradient(to right, ' + colors.join(', ') + ')';
  const powers = [];
  for (let value = low; value <= 1.001 * high; value *= 10) powers.push(Number(value.toPrecision(1)));
  const place = value => 100 * Math.log(value / low) / Math.log(high / low) + '%';
  return element('div', {class: 'ramp', '--ramp': ramp},
    powers.map(value => element('span', {'--place': place(value)}, String(value))),
    element('span', {class: 'ramp-unit'}, unit));
}

function legendOf(scale) {
  return element('div', {class: 'legend', role: 'img', 'aria-label': 'Colours of the error from ' + scale.low + ' to ' + scale.high + ' pixels, logarithmic'},
    rampOf(scale.colors, scale.low, scale.high, 'px'),
    element('span', {class: 'swatch', '--color': scale.unbounded}, 'no bound'),
    element('span', {class: 'swatch hatch'}, 'no terrain'));
}

function legendOfWork(scale) {
  return element('div', {class: 'legend', role: 'img', 'aria-label': 'Colours of the taps of a pixel from ' + scale.work_low + ' to ' + scale.work_high + ', logarithmic'},
    rampOf(scale.colors, scale.work_low, scale.work_high, 'taps'),
    element('span', {class: 'swatch hatch'}, 'none'));
}

function factsOf(row) {
  const error = row.error || {};
  const px = error.reprojection_px || {};
  return [
    ['median', figure(at(row, 'ms.median')) + ' ms'], ['× texture', fixed(row.ratio_to_texture, 2)],
    ['error RMS', figure(px.rms) + ' px' + unboundedText(row)], ['p99', figure(px.p99) + ' px'],
    ['wrong', figure(error.wrong_percent) + ' %'], ['FLIP', figure(error.flip)],
  ];
}

function factList(row) {
  return element('dl', {class: 'facts'}, factsOf(row).map(([name, value]) =>
    element('div', {}, element('dt', {}, name), element('dd', {}, value))));
}

function picture(source, name, shown) {
  return element('img', {src: source, alt: name, width: shown.width, height: shown.height, loading: 'lazy', draggable: 'false'});
}

// Shows the left part of the picture, up to the slider, over the other one.
function wipeTo(wipe, value) {
  wipe.range.value = value;
  wipe.stage.style.setProperty('--wipe', wipe.range.value + '%');
  wipe.range.setAttribute('aria-valuetext', wipe.range.value + ' % ' + wipe.names[0] + ', the rest ' + wipe.names[1]);
}

function wipeByPointer(wipe, event) {
  if (event.type === 'pointerdown') wipe.stage.setPointerCapture(event.pointerId);
  if (event.type === 'pointermove' && !wipe.stage.hasPointerCapture(event.pointerId)) return;
  const box = wipe.stage.getBoundingClientRect();
  wipeTo(wipe, 100 * (event.clientX - box.left) / box.width);
}

function compareWith(wipe, name, source) {
  wipe.under.src = source;
  wipe.under.alt = name;
  wipe.names[1] = name;
  wipe.right.textContent = name;
  wipeTo(wipe, wipe.range.value);
}

function stageOf(wipe, shown, sources, title) {
  wipe.under = picture(sources.truth, 'truth', shown);
  wipe.right = element('span', {class: 'side right', 'aria-hidden': 'true'}, 'truth');
  const onPointer = event => wipeByPointer(wipe, event);
  wipe.stage = element('div', {class: 'stage', '--aspect': shown.width + ' / ' + shown.height, onpointerdown: onPointer, onpointermove: onPointer},
    wipe.under,
    element('div', {class: 'over'}, picture(sources.shown, title, shown)),
    element('span', {class: 'edge', 'aria-hidden': 'true'}),
    element('span', {class: 'side left', 'aria-hidden': 'true'}, 'picture'), wipe.right);
  return wipe.stage;
}

function againstChoice(wipe, sources, id) {
  const choices = [['truth', 'truth'], ['heat', 'error'], ['work', 'taps']].filter(([key]) => sources[key]);
  return element('fieldset', {class: 'against'}, element('legend', {}, 'Picture against'),
    choices.map(([key, name]) => element('label', {},
      element('input', {type: 'radio', name: 'against-' + id, checked: key === 'truth', onchange: () => compareWith(wipe, name, sources[key])}), name)));
}

function wipeOf(shown, sources, title, id) {
  const wipe = {names: ['picture', 'truth']};
  wipe.range = element('input', {type: 'range', min: '0', max: '100', step: '1', value: '50',
    'aria-label': 'How much of the picture is shown: ' + title, oninput: () => wipeTo(wipe, wipe.range.value)});
  const node = element('div', {class: 'wipe'}, stageOf(wipe, shown, sources, title), wipe.range, againstChoice(wipe, sources, id));
  wipeTo(wipe, 50);
  return node;
}

function strip(shown, sources, title) {
  const panels = [['shown', 'picture'], ['truth', 'truth'], ['heat', 'error'], ['work', 'taps']].filter(([key]) => sources[key]);
  return element('div', {class: 'strip'}, panels.map(([key, name]) =>
    element('figure', {}, picture(sources[key], name + ' of ' + title, shown), element('figcaption', {}, name))));
}

function comparison(shown, row, album) {
  const sources = {shown: album.images[shown.shown], truth: album.images[shown.truth], heat: album.images[shown.heat], work: album.images[shown.work]};
  const title = labelOf(row) + ', ' + titleOf(row);
  return element('article', {class: 'comparison', id: 'row-' + shown.row},
    element('header', {}, element('h3', {}, labelOf(row)), element('p', {class: 'place'}, titleOf(row)), tagsOf(row)),
    factList(row),
    element('div', {class: 'side-by-side'}, wipeOf(shown, sources, title, shown.row), strip(shown, sources, title)),
    legendOf(album.scale), sources.work ? legendOfWork(album.scale) : null);
}

function showPictures(report, album) {
  if (!album.rows.length) return;
  byId('pictures').append(
    element('h2', {}, 'Pictures'),
    element('p', {class: 'note'}, 'Drag across a picture, or move the slider below it with the arrow keys, to compare the picture with the true one.'),
    ...album.rows.map(shown => comparison(shown, report.rows[shown.row], album)));
}
