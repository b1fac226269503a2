// Puts the page together: what one chosen pair shows in all of its places.
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
  const showOnlyPairs = values => {
    table.filter(values);
    byId('pairs').scrollIntoView({ block: 'nearest' });
  };
  showHeader(report, showOnlyPairs);
  showSkipped(report.skipped);
  showList('violated', report.violated);  // what keeps a posture from being feasible
  showWarnings(report.warnings);
  showParts(report);
  showWords(report);
  showTask(report);
  const scene = openScene(report), table = new PairTable(report, i => choose(i, true));
  const map = new HeatMap(report, i => {
    choose(i, true);
    table.reveal(i);
    byId('scene').scrollIntoView({ block: 'nearest' });
  });
  const chart = new Chart(report, (i, moment) => {
    choose(i, true, moment);
    table.reveal(i);
    byId('scene').scrollIntoView({ block: 'nearest' });
  });
  new LinkTable(report, link => showOnlyPairs({ link }));
  const show = what => {
    if (scene) scene.showOnly(what);
    for (const button of byId('show').children) button.setAttribute('aria-pressed', button.dataset.value === what);
    document.body.dataset.show = what;
  };
  const choose = (i, isolate, moment = firstContact(report, pairs[i])) => {
    if (isolate && document.body.dataset.show === 'all') show('context');
    table.mark(i);
    map.mark(i);
    const seen = { ...pairs[i], ...moment };
    describe(pairs[i], report, moment, to => choose(i, isolate, to));
    chart.mark(seen.time_share);
    if (scene) scene.select(seen, isolate);
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
    scene.look(number('yaw', scene.clearYaw(0.7)), number('pitch', 0.25), scene.firstZoom);
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
