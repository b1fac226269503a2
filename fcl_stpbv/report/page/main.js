// Puts the page together: figures, warnings, links, and what one selected pair shows in all of them.
function showHeader(report) {
  const s = report.summary, title = `${report.robot}: ${report.title}`;
  document.title = byId('title').textContent = title;
  byId('subtitle').textContent = report.pose ? `Posture: ${report.pose}`
    : report.trajectory ? `Trajectory ${report.trajectory.file}: ${report.trajectory.verdict}. Checked pairs where they come closest on it, others where it begins` : 'Each pair in the closest configuration that was found';
  const figure = (value, label, className = '') => byId('figures').append(make('div', `figure ${className}`, '', make('b', '', String(value)), make('span', '', label)));
  const verdict = report.trajectory && report.trajectory.verdict, proven = !verdict || verdict === 'proven free';
  if (verdict) figure(proven ? 'free' : verdict.startsWith('CONTACT') ? 'contact' : 'not decided', 'trajectory', proven ? 'good' : 'bad');
  figure(s.pairs_total, s.pairs_total === 1 ? 'pair' : 'pairs');
  figure(s.checked, 'checked');
  figure(s.colliding, hitWord(report), s.colliding ? 'bad' : s.checked && proven && !report.skipped.length ? 'good' : '');
  if (report.skipped.length) figure(report.skipped.length, 'left out', 'bad');
  const causes = new Map();
  for (const p of report.pairs) if (p.checked && p.colliding && p.cause) causes.set(p.cause, (causes.get(p.cause) || 0) + 1);
  for (const [cause, count] of causes) figure(count, cause);
  figure(s.min_distance === null ? '–' : mm(s.min_distance), 'least distance [mm]', s.colliding ? 'bad' : '');
  if (s.ns_per_pair) figure(s.ns_per_pair.toFixed(0), 'ns a pair');
}

// A place that is there only with something to list in it.
function showList(id, lines) {
  byId(id).hidden = !lines.length;
  byId(id).lastElementChild.replaceChildren(...lines.map(text => make('li', '', text)));
}

// Shapes that nothing was checked against: no figure on the page holds for them.
function showSkipped(shapes) {
  showList('skipped', shapes);
  byId('skipped').firstElementChild.textContent = `Left out and not checked: ${shapes.length === 1 ? '1 shape' : `${shapes.length} shapes`}`;
}

function showWarnings(warnings) {
  showList('warnings', warnings);
  byId('warnings').open = warnings.length <= 3;
  byId('warnings').firstElementChild.textContent = warnings.length === 1 ? '1 warning' : `${warnings.length} warnings`;
}

// Links, those whose volume exceeds their mesh most first.
function showLinks(links) {
  const columns = [['name', 'Link'], ['volume_excess', 'Volume over mesh mm'], ['hull_excess', 'Hull over mesh mm'], ['over_cover_max', 'Volume over hull mm'], ['volume_ratio', 'Volume / mesh'],
    ['r', 'r mm'], ['R', 'R m'], ['vertices', 'Vertices']].filter(([key]) => links.some(link => link[key] !== null && link[key] !== undefined));
  const worst = link => link.volume_excess ?? link.over_cover_max ?? -1;
  byId('links').hidden = columns.length < 2;
  for (const [key, label] of columns) document.querySelector('#linktable thead tr').append(make('th', key === 'name' ? '' : 'n', label));
  const text = (key, v) => v === null || v === undefined ? '–' : key === 'vertices' ? String(v) : key === 'R' || key === 'volume_ratio' ? brief(v) : mm(v);
  for (const link of [...links].sort((a, b) => worst(b) - worst(a))) {
    const row = make('tr');
    for (const [key] of columns) row.append(make('td', key === 'name' ? '' : 'n', key === 'name' ? link.name : text(key, link[key])));
    row.firstChild.title = link.file || link.name;
    document.querySelector('#linktable tbody').append(row);
  }
}

// Both links, each behind its colour.
function namesOf(pair) {
  const side = (dot, name) => make('span', 'side', '', make('span', `dot ${dot}`), name);
  return make('div', 'names', '', side('first', pair.link1), make('i', '', 'and'), side('second', pair.link2));
}

// Also where a page that came by plain http has no clipboard.
async function copied(text) {
  if (navigator.clipboard) return navigator.clipboard.writeText(text);
  const box = make('textarea', '', text);
  document.body.append(box);
  box.select();
  document.execCommand('copy');
  box.remove();
}

function describe(pair, report) {
  const facts = make('dl', 'facts'), tags = make('div', 'tags'), slopes = make('div', 'slopes');
  const fact = (label, value, className = '') => facts.append(make('div', '', '', make('dt', '', label), make('dd', className, value)));
  const [state, look] = stateOf(pair, report);
  tags.append(make('span', `tag ${look}`, state), make('span', 'tag', pair.reason));
  if (pair.cause) tags.append(causeTag(pair.cause));
  if (pair.srdf_reason) tags.append(make('span', 'tag', `SRDF: ${pair.srdf_reason}`));
  if (pair.contradicts_srdf) tags.append(make('span', 'tag warn', 'contradicts the SRDF'));
  if (!pair.continuous) tags.append(make('span', 'tag warn', 'gradient may jump'));
  fact('STP-BV [mm]', mm(pair.distance, 3), pair.colliding ? 'hit' : '');
  fact('Hulls [mm]', mm(pair.hull_distance, 3));
  if (pair.mesh_distance !== null) fact('Meshes [mm]', mm(pair.mesh_distance, 3));
  fact('Cover, 1 + 2 [mm]', `${mm(pair.over_cover1)} + ${mm(pair.over_cover2)}`);
  fact('Least in samples [mm]', mm(pair.min_distance, 3));
  if (pair.time !== null) fact(report.trajectory.timed ? 'Closest at' : 'Closest at way point', pair.time_text);
  fact('Normal', pair.normal.map(v => fixed(v, 3)).join(', '));
  const steep = Object.entries(pair.gradient).filter(([, slope]) => slope !== 0).sort((a, b) => Math.abs(b[1]) - Math.abs(a[1])).slice(0, 6);
  const shorten = shortener(report.joints);
  if (steep.length) slopes.append(make('b', '', 'Steepest joints [m/rad, m/m]'));
  for (const [joint, slope] of steep) {
    const bar = make('em'), share = 50 * Math.abs(slope) / Math.max(1e-12, Math.abs(steep[0][1]));
    bar.style.cssText = `left: ${slope < 0 ? 50 - share : 50}%; width: ${share}%`;
    const name = make('span', '', shorten(joint, text => text.length <= 30));
    name.title = joint;
    slopes.append(name, make('div', 'way', '', bar), make('span', 'n', (slope > 0 ? '+' : '') + brief(slope)));
  }
  const copy = make('button', '', 'Copy posture');
  copy.title = 'The joint values, as a file for --pose';
  copy.onclick = () => copied(JSON.stringify(Object.fromEntries(report.joints.map((name, k) => [name, report.configurations[pair.posture][k]]))))
    .then(() => { copy.textContent = 'Copied'; });
  tags.append(copy);
  byId('detail').replaceChildren(namesOf(pair), tags, facts, slopes);
}

// Where on the trajectory's chart the chosen pair is closest: a share of the whole time, none of a pair that was not followed.
function markTime(share) {
  const chart = document.querySelector('#trajectory svg'), line = chart && chart.querySelector('#chosen');
  if (!line) return;
  const { left, right } = chart.dataset, x = share === undefined ? -9 : Number(left) + share * (right - left);
  line.setAttribute('x1', x);
  line.setAttribute('x2', x);
}

function buttons(box, choices, onChoose) {
  for (const [value, label] of Object.entries(choices)) {
    const button = make('button', '', label);
    button.dataset.value = value;
    button.onclick = () => onChoose(value);
    byId(box).append(button);
  }
}

// Where the browser draws no WebGL the rest of the page works all the same.
function openScene(report) {
  try {
    return new Scene(report, byId('view'));
  } catch (error) {
    byId('hint').textContent = `This browser does not draw 3-D (${error.message}).`;
    return null;
  }
}

async function main() {
  const script = make('script', '', await unpacked('packed-three'));
  document.head.append(script);
  const report = JSON.parse(await unpacked('packed-report')), pairs = report.pairs;
  if (report.summary.margin > 0) for (const p of pairs) if (p.cause && !COVERS_ONLY.includes(p.cause)) p.cause = 'meshes within it';
  showHeader(report);
  showSkipped(report.skipped);
  showList('violated', report.violated);  // what keeps a posture from being feasible
  showWarnings(report.warnings);
  showLinks(report.links);
  showTask(report);
  const scene = openScene(report), table = new PairTable(report, i => choose(i, true)), map = new HeatMap(report, i => choose(i, true));
  const show = what => {
    if (scene) scene.showOnly(what);
    for (const button of byId('show').children) button.setAttribute('aria-pressed', button.dataset.value === what);
    document.body.dataset.show = what;
  };
  const choose = (i, isolate) => {
    if (isolate && document.body.dataset.show === 'all') show('context');
    table.mark(i);
    map.mark(i);
    describe(pairs[i], report);
    markTime(pairs[i].time_share);
    if (scene) scene.select(pairs[i], isolate);
    document.body.dataset.selected = i;
  };
  buttons('show', { all: 'All links', context: 'Pair in context', pair: 'Pair alone' }, what => { show(what); if (scene) scene.frame(); });
  buttons('views', { front: 'Front', side: 'Side', top: 'Top', fit: 'Fit' }, from =>
    scene && (from === 'fit' ? scene.frame() : scene.look(...{ front: [0, 0], side: [Math.PI / 2, 0], top: [0, 1.5707] }[from])));

  // report.html#yaw=0.8&pitch=0.3&zoom=1&pair=4&show=all opens that view; picture=1 leaves nothing but the robot.
  const openAsked = () => {
    const asked = new URLSearchParams(location.hash.slice(1)), number = (name, otherwise) => asked.has(name) ? Number(asked.get(name)) : otherwise;
    document.body.classList.toggle('picture', asked.has('picture'));
    show(asked.get('show') || 'all');
    if (pairs.length && number('pair', 0) >= 0) choose(pairs[number('pair', 0)] ? number('pair', 0) : 0, false);
    else byId('detail').textContent = 'No pair is selected.';
    if (!scene) return;
    scene.firstZoom = number('zoom', 1);
    scene.look(number('yaw', 0.7), number('pitch', 0.25), scene.firstZoom);
  };
  openAsked();
  window.addEventListener('hashchange', openAsked);
  window.scene = scene;  // for scripts that measure the page
  document.body.dataset.ready = 'yes';
}

main().catch(error => {
  byId('subtitle').textContent = `This page could not be opened: ${error.message}. It needs a browser with DecompressionStream (Chromium 80, Firefox 113, Safari 16.4 or newer).`;
  throw error;
});
