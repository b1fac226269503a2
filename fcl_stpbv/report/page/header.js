// The top of the page: what it reports, its figures, what was left out, warnings; and at its foot what the words mean.
function showHeader(report, onFilter) {
  const s = report.summary, title = `${report.robot}: ${report.title}`;
  document.title = byId('title').textContent = title;
  byId('subtitle').textContent = report.pose ? `Posture: ${report.pose}`
    : report.trajectory ? `Trajectory ${report.trajectory.file}: ${report.trajectory.verdict}. Checked pairs where they come closest on it, ` +
      'others where it begins' : 'Each pair in the closest configuration that was found';
  // With a filter, a click shows the pairs that a figure counts.
  const figure = (value, label, className = '', filter = null) => {
    const card = make(filter ? 'button' : 'div', `figure ${className}`, '', make('b', '', String(value)), make('span', '', label));
    if (filter) card.onclick = () => onFilter(filter);
    return card;
  };
  const show = (...card) => byId('figures').append(figure(...card));
  const verdict = report.trajectory && report.trajectory.verdict, proven = !verdict || verdict === 'proven free';
  if (verdict) show(proven ? 'free' : verdict.startsWith('CONTACT') ? 'contact' : 'not decided', 'trajectory', proven ? 'good' : 'bad');
  show(s.pairs_total, s.pairs_total === 1 ? 'pair' : 'pairs', '', {});
  show(s.checked, 'checked', '', { state: 'checked' });
  const causes = new Map();
  for (const p of report.pairs) if (p.checked && p.colliding && p.cause) causes.set(p.cause, (causes.get(p.cause) || 0) + 1);
  const look = s.colliding ? 'bad' : s.checked && proven && !report.skipped.length ? 'good' : '';
  byId('figures').append(make('div', 'group', '', figure(s.colliding, hitWord(report), look, s.colliding ? { state: 'colliding' } : null),
    ...[...causes].map(([cause, count]) => figure(count, cause, 'part', { state: 'colliding', cause }))));
  if (report.skipped.length) show(report.skipped.length, 'left out', 'bad');
  show(s.min_distance === null ? '–' : mm(s.min_distance), 'least distance [mm]', s.colliding ? 'bad' : '');
  if (s.ns_per_pair) byId('foot').textContent = `A distance with its gradient took ${s.ns_per_pair.toFixed(0)} ns, the mean over the checked pairs.`;
}

// A place that is there only with something to list in it.
function showList(id, lines) {
  byId(id).hidden = !lines.length;
  byId(id).lastElementChild.replaceChildren(...lines.map(text => make('li', '', text)));
}

// Shapes that nothing was checked against: no figure on the page holds for them.
function showSkipped(shapes) {
  showList('skipped', shapes);
  byId('skipped').firstElementChild.textContent = `Left out and not checked: ${counted(shapes.length, 'shape')}`;
}

function showWarnings(warnings) {
  showList('warnings', warnings);
  byId('warnings').open = warnings.length <= 3;
  byId('warnings').firstElementChild.textContent = counted(warnings.length, 'warning');
}

const WORDS = {
  'meshes meet': 'in collision: the triangle meshes themselves touch',
  'hull only': 'in collision: the convex hulls touch, the meshes do not; convex parts may help',
  'margin only': 'in collision: only the smooth covers around the hulls touch, or the margin is larger than their distance',
  'meshes within it': 'the meshes themselves come within the margin',
  adjacent: 'over all postures: joined by one moving joint',
  rigid: 'over all postures: only fixed joints are between the two, so their distance never changes',
  default: 'over all postures: in collision in the neutral one and in all others that were tried',
  'default (clears elsewhere)': 'over all postures: in collision in the neutral one, clear in another',
  'nearly always': 'over all postures: in collision in at least 95 % of the samples, which may leave this one clear',
  sometimes: 'over all postures: in collision in some of them',
  'never (sampled)': 'over all postures: in collision in none that was tried, without a proof',
  'never (proven)': 'over all postures: in collision in none within the limits, by proof',
  user: 'left out by an entry of the SRDF itself',
  self: 'two links of the robot',
  obstacle: 'a link and an obstacle'
};

// Only words that the page has.
function showWords(report) {
  const list = byId('words').lastElementChild, say = (word, text) => list.append(make('div', '', '', make('dt', '', word), make('dd', '', text)));
  say('STP-BV', 'the smooth volume around a link, a sphere-torus-patch bounding volume; distances between two of them are negative where they overlap');
  say('Hulls', 'distance of the convex hulls; "overlap" where they overlap, as their depth is not measured');
  say('Meshes', 'distance of the triangle meshes, 0 where they meet; – where it was not measured, because the volumes are far enough apart');
  say('Cover', 'how far the two volumes stand off their hulls along the normal, that of the first link and that of the second, and their sum in the table');
  const used = new Set(report.pairs.flatMap(p => [p.cause, reasonWord(p.reason)]));
  for (const [word, text] of Object.entries(WORDS)) if (used.has(word)) say(word, text);
  if (report.pairs.some(p => p.verdict === 'undecided')) say('not decided', 'the trajectory is neither proven free of this pair nor has a contact of it been found');
  if (report.pairs.some(p => !p.checked)) say('not checked', 'the SRDF, or without one the search, leaves this pair out; its figures are given all the same');
  if (report.pairs.some(p => p.contradicts_srdf)) say('contradicts the SRDF', 'the SRDF leaves the pair out as one that never collides, and it does');
  if (report.pairs.some(p => !p.continuous)) say('gradient may jump', 'neither of the two bodies is smooth');
}
