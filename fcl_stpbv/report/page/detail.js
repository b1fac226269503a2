// What is known of the chosen pair: tags, figures, the steepest joints. On a trajectory it is shown where the two are
// closest, or at another moment: the first contact, or one that was chosen on the chart.

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

function copyButton(report, posture) {
  const copy = make('button', 'copy', 'Copy posture');
  copy.title = 'The joint values, as a file for --pose';
  copy.onclick = () => copied(JSON.stringify(Object.fromEntries(report.joints.map((name, k) => [name, report.configurations[posture][k]])))).then(() => {
    copy.textContent = 'Copied';
    setTimeout(() => { copy.textContent = 'Copy posture'; }, 2500);
  });
  return copy;
}

function slopesOf(gradient, joints) {
  const slopes = make('div', 'slopes'), shorten = shortener(joints);
  const steep = Object.entries(gradient).filter(([, slope]) => slope !== 0).sort((a, b) => Math.abs(b[1]) - Math.abs(a[1])).slice(0, 6);
  if (steep.length) slopes.append(make('b', '', 'Steepest joints [m/rad, m/m]'));
  for (const [joint, slope] of steep) {
    const bar = make('em'), share = 50 * Math.abs(slope) / Math.max(1e-12, Math.abs(steep[0][1]));
    bar.style.cssText = `left: ${slope < 0 ? 50 - share : 50}%; width: ${share}%`;
    const name = make('span', '', shorten(joint, text => text.length <= 30));
    name.title = joint;
    slopes.append(name, make('div', 'way', '', bar), make('span', 'n', (slope > 0 ? '+' : '') + fixed(slope, 3)));
  }
  return slopes;
}

// The moments of a trajectory that the pair can be shown at.
function momentButtons(pair, report, moment, onMoment) {
  const box = make('div', 'moments'), contact = firstContact(report, pair);
  if (!moment && !contact) return box;
  for (const [label, to] of [...(contact ? [['At first contact', contact]] : []), ['At closest', null]]) {
    const button = make('button', '', label);
    button.setAttribute('aria-pressed', moment === to);
    button.onclick = () => onMoment(to);
    box.append(button);
  }
  return box;
}

function describe(pair, report, moment, onMoment) {
  const facts = make('dl', 'facts'), tags = make('div', 'tags'), seen = { ...pair, ...moment };
  const fact = (label, value, className = '') => facts.append(make('div', '', '', make('dt', '', label), make('dd', className, value)));
  const [state, look] = stateOf(pair, report), at = report.trajectory && !report.trajectory.timed ? ' at way point' : ' at';
  tags.append(make('span', `tag ${look}`, state));
  if (!moment && pair.cause) tags.append(causeTag(pair.cause));  // which is known of where the two are closest
  tags.append(make('span', 'tag', report.sampled ? `over all postures: ${reasonWord(pair.reason)}` : pair.reason));
  if (pair.srdf_reason) tags.append(make('span', 'tag', `SRDF: ${pair.srdf_reason}`));
  if (pair.contradicts_srdf) tags.append(make('span', 'tag warn', 'contradicts the SRDF'));
  if (!pair.continuous) tags.append(make('span', 'tag warn', 'gradient may jump'));
  if (moment) fact(moment.label + at, moment.time_text);
  fact('STP-BV [mm]', mm(seen.distance, 3), seen.distance <= report.summary.margin ? 'hit' : '');
  const measured = !moment || moment.normal;  // of a moment on the chart there is the distance alone
  if (measured) {
    fact('Hulls [mm]', seen.hull_distance === null ? 'overlap' : mm(seen.hull_distance, 3));
    if (!moment && pair.mesh_distance !== null) fact('Meshes [mm]', mm(pair.mesh_distance, 3));
    fact('Cover, 1 + 2 [mm]', `${mm(seen.over_cover1)} + ${mm(seen.over_cover2)}`);
  }
  if (report.sampled && !moment) fact('Least in samples [mm]', mm(pair.min_distance, 3));
  if (pair.time !== null) fact('Closest' + at, pair.time_text);
  if (measured) fact('Normal', seen.normal.map(v => fixed(v, 3)).join(', '));
  tags.append(copyButton(report, seen.posture));
  const moments = momentButtons(pair, report, moment, onMoment);
  byId('detail').replaceChildren(namesOf(pair), tags, moments, facts, measured ? slopesOf(seen.gradient, report.joints) : '');
}
