// report.js: the page of a comparison: surface, residues, numbers. Reads the record and the arrays in the page.
'use strict';
(async function () {
  const { byId, record, add, shown, decode } = Page;

  showTexts();
  const arrays = await Page.unpack();
  const n = record.n_vertices;
  const target = decode(record.positions.target), source = record.positions.source ? decode(record.positions.source) : target;
  const triangles = Page.decodeTriangles(record.triangles), cover = coverOf(record.cover), residueOf = new Int32Array(arrays, record.residue.offset, n);
  const patchOf = record.patch ? new Int32Array(arrays, record.patch.offset, n) : null;  // 0: in none
  const values = Page.decodeAll(record.quantities), fade = record.fade;
  const doubt = fade ? values[record.quantities.findIndex((q) => q.name === fade.name)] : undefined;  // of the values, at each vertex
  byId('waiting').remove();

  // [vertex] shares of matched and of trusted surroundings; what is marked lies below 0.5.
  function coverOf({ matched, trusted }) {
    const shares = new Float32Array(2 * n).fill(1);
    [matched, trusted].forEach((part, k) => { if (part) decode(part).forEach((share, v) => { shares[2 * v + k] = share; }); });
    return shares;
  }

  // ---- texts ----------------------------------------------------------------------------------------------------

  function showTexts() {
    Page.showHead(record.states);
    for (const table of record.tables || []) Page.showTable(byId('tables'), table);
    for (const section of record.numbers) {
      const box = add(byId('numbers'), 'div');
      add(box, 'h2', section.title);
      const table = add(box, 'table');
      for (const row of section.rows) {
        const line = add(table, 'tr');
        const label = add(line, 'td', row.label);
        add(label, 'div', row.help, 'help');
        add(line, 'td', row.value);
      }
    }
    Page.showProvenance();
  }

  // ---- colours --------------------------------------------------------------------------------------------------

  function colourOf(quantity, value, range, scale) {
    if (isNaN(value)) return record.no_value;
    const t = quantity.signed ? 0.5 + 0.5 * value / range : value / range;
    return scale[Math.max(0, Math.min(scale.length - 1, Math.round(t * (scale.length - 1))))];
  }

  // Whether a place of the source is compared with its place on the target.
  const compares = (quantity) => quantity.name !== 'slip' && quantity.name !== 'why' && !/_(source|target)$/.test(quantity.name);

  // The scale by name; magnitudes have one of their own.
  function scaleOf(quantity) { return record.scales[quantity.signed ? byId('colours').value : 'magnitude']; }

  function paint(mesh, index, range) {
    const quantity = record.quantities[index], scale = scaleOf(quantity), colours = mesh.colours, column = values[index];
    mesh.why.value = quantity.name === 'why' ? 1 : 0;  // the shader has the colours then
    for (let v = 0; v < n && !mesh.why.value; ++v) {
      const rgb = colourOf(quantity, column[v], range, scale);
      for (let k = 0; k < 3; ++k) colours[3 * v + k] = rgb[k] / 255;
    }
    mesh.geometry.attributes.color.needsUpdate = true;
    mesh.marks.value = compares(quantity) ? 1 : 0;
    mesh.fades.value = doubt && column !== doubt && byId('fade').checked ? 1 : 0;
  }

  // ---- scene ----------------------------------------------------------------------------------------------------

  const holder = byId('canvas');
  const renderer = new THREE.WebGLRenderer({ antialias: true, alpha: true, preserveDrawingBuffer: true });
  renderer.setPixelRatio(window.devicePixelRatio || 1);
  holder.appendChild(renderer.domElement);
  const camera = new THREE.PerspectiveCamera(30, 1, 1, 10000);
  const controls = new THREE.TrackballControls(camera, renderer.domElement);
  controls.staticMoving = true;
  controls.rotateSpeed = 3;
  const centre = new THREE.Vector3(), corner = new THREE.Vector3();
  const bounds = new THREE.Box3().setFromArray(target);
  bounds.getCenter(centre);
  const radius = bounds.getSize(corner).length() / 2;

  // [vertex] shares of the reasons but the first around it, in two arrays of four; of a page without reasons 0.
  const reasons = record.reasons || [], reasonShares = [0, 1].map((half) => {
    const shares = new Float32Array(4 * n);
    reasons.slice(1).forEach((reason, r) => {
      if (reason.text && Math.floor(r / 4) === half) decode(reason).forEach((share, v) => { shares[4 * v + r % 4] = share; });
    });
    return shares;
  });

  // [vertex] how faint its values are drawn, 0 to 1; of a limit (from = to) the share around it that is beyond.
  const faint = !doubt ? new Float32Array(n) : fade.from === fade.to ? shareAround((v) => doubt[v] > fade.from)
    : Float32Array.from(doubt, (value) => (value >= 0 ? Math.max(0, Math.min(1, (value - fade.from) / (fade.to - fade.from))) : 0));

  // As the shaders of pictures: grey where the place is not trusted, stripes where it is unmatched, open inside tears.
  function marked(material, mesh) {
    const glsl = (rgb) => 'vec3(' + rgb.map((c) => (c / 255).toFixed(4)).join(', ') + ')', grey = glsl(record.no_value);
    // Of the reason that most of the surroundings have.
    const ofReason = reasons.map(({ colour }, r) => (r === 0 ? 'vec3 reason = ' + glsl(colour) + '; float most = 1.0 - dot(vReasonsA, vec4(1.0)) - dot(vReasonsB, vec4(1.0)), here;'
      : 'here = vReasons' + (r < 5 ? 'A' : 'B') + '[' + (r - 1) % 4 + ']; if (here > most) { most = here; reason = ' + glsl(colour) + '; }')).join('\n');
    const after = (text, name, more) => text.replace('#include <' + name + '>', '#include <' + name + '>\n' + more);
    material.extensions = { derivatives: true };
    material.onBeforeCompile = (shader) => {
      shader.uniforms.marks = mesh.marks;
      shader.uniforms.why = mesh.why;
      shader.uniforms.fades = mesh.fades;
      shader.uniforms.pitch = { value: 7 * renderer.getPixelRatio() };
      shader.vertexShader = after(after(shader.vertexShader, 'common', 'attribute vec2 cover; attribute float faint; attribute vec4 reasonsA, reasonsB; varying vec2 vCover; varying float vFaint; varying vec4 vReasonsA, vReasonsB;'), 'begin_vertex', 'vCover = cover; vFaint = faint; vReasonsA = reasonsA; vReasonsB = reasonsB;');
      shader.fragmentShader = after(after(shader.fragmentShader, 'common', 'varying vec2 vCover; varying float vFaint; varying vec4 vReasonsA, vReasonsB; uniform float marks, why, fades, pitch;'), 'color_fragment', `
        if (vCover.x < -0.4) discard;
        vec2 inside = clamp((vCover - 0.5) / max(fwidth(vCover), 1e-6) + 0.5, 0.0, 1.0);
        vec3 stripes = mod(gl_FragCoord.x - gl_FragCoord.y, pitch) < 0.4 * pitch ? ${grey} : vec3(0.93);
        ${ofReason}
        float faint = ${fade && fade.from === fade.to ? 'clamp((vFaint - 0.5) / max(fwidth(vFaint), 1e-6) + 0.5, 0.0, 1.0)' : 'vFaint'};
        diffuseColor.rgb = mix(diffuseColor.rgb, vec3(0.745), 0.75 * faint * fades * (1.0 - why));
        ${reasons.length ? 'if (why > 0.5) diffuseColor.rgb = reason;' : ''}
        diffuseColor.rgb = mix(diffuseColor.rgb, ${grey}, (1.0 - inside.y) * marks);
        diffuseColor.rgb = mix(stripes, diffuseColor.rgb, inside.x);`);
    };
    return material;
  }

  // A surface between source (0) and target (1), with the outline of the picked residue.
  function makeMesh(morph) {
    const mesh = { geometry: new THREE.BufferGeometry(), colours: new Float32Array(3 * n), scene: new THREE.Scene() };
    mesh.geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(3 * n), 3));
    mesh.geometry.setAttribute('color', new THREE.BufferAttribute(mesh.colours, 3));
    mesh.geometry.setAttribute('cover', new THREE.BufferAttribute(cover, 2));
    mesh.geometry.setAttribute('faint', new THREE.BufferAttribute(faint, 1));
    ['reasonsA', 'reasonsB'].forEach((name, half) => mesh.geometry.setAttribute(name, new THREE.BufferAttribute(reasonShares[half], 4)));
    mesh.geometry.setIndex(new THREE.BufferAttribute(triangles, 1));
    mesh.geometry.computeVertexNormals();
    mesh.marks = { value: 1 };
    mesh.why = { value: 0 };
    mesh.fades = { value: 0 };
    const side = THREE.DoubleSide, vertexColors = THREE.VertexColors || true;
    mesh.surface = new THREE.Mesh(mesh.geometry, marked(new THREE.MeshLambertMaterial({ vertexColors, side, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 }), mesh));  // outlines lie on it
    mesh.scene.add(mesh.surface);
    mesh.outline = new THREE.LineSegments(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({ color: 0x000000 }));
    mesh.scene.add(mesh.outline);
    mesh.scene.add(new THREE.HemisphereLight(0xffffff, 0xd0d0d0, 0.75));
    mesh.light = new THREE.DirectionalLight(0xffffff, 0.35);
    mesh.scene.add(mesh.light);
    mesh.scene.add(mesh.light.target);
    if (record.backbone) {
      mesh.ribbon = new THREE.Mesh(new THREE.BufferGeometry(), new THREE.MeshLambertMaterial({ color: 0xc98a1b, side }));
      // Only the nearest layer of the surface shows: its depth is drawn first, after the ribbon.
      mesh.depth = new THREE.Mesh(mesh.geometry, marked(new THREE.MeshBasicMaterial({ colorWrite: false, side, transparent: true, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 }), mesh));
      mesh.depth.renderOrder = 1;
      mesh.surface.renderOrder = 2;
      mesh.scene.add(mesh.ribbon, mesh.depth);
    }
    place(mesh, morph);
    return mesh;
  }

  function place(mesh, morph) {
    const at = mesh.geometry.attributes.position;
    for (let i = 0; i < 3 * n; ++i) at.array[i] = source[i] + morph * (target[i] - source[i]);
    at.needsUpdate = true;
    mesh.morph = morph;
    showMolecule(mesh);
    mesh.geometry.computeVertexNormals();
    mesh.geometry.computeBoundingSphere();
    outline(mesh);
  }

  // The ribbon, and a surface through which it is seen.
  function showMolecule(mesh) {
    if (!mesh.ribbon) return;
    const isShown = byId('molecule').checked;
    mesh.ribbon.visible = mesh.depth.visible = mesh.surface.material.transparent = isShown;
    mesh.surface.material.opacity = isShown ? 0.55 : 1;
    mesh.surface.material.needsUpdate = true;
    if (isShown) mesh.ribbon.geometry = Page.ribbon(mesh.morph);
  }

  // [vertex] share of its surroundings that is inside, averaged over neighbours twice, so that borders do not follow edges.
  function shareAround(isInside) {
    let share = Float32Array.from({ length: n }, (_, v) => (isInside(v) ? 1 : 0));
    for (let round = 0; round < 2; ++round) {
      const sum = new Float32Array(n), count = new Float32Array(n);
      for (let i = 0; i < triangles.length; ++i) {
        const v = triangles[i], next = triangles[i % 3 === 2 ? i - 2 : i + 1];  // each edge, from one of its ends a triangle
        sum[v] += share[next]; ++count[v];
      }
      share = share.map((own, v) => (count[v] ? (own + sum[v] / count[v]) / 2 : own));
    }
    return share;
  }

  let picked = -1, pickedPatch = -1;
  const shownShares = [0, 1].map(() => ({ of: -1, share: null }));  // of the picked residue and patch
  function sharesOfPicked() {
    return [[picked, (v) => residueOf[v] === picked], [patchOf ? pickedPatch : -1, (v) => patchOf[v] === pickedPatch + 1]].map(([of, isInside], k) => {
      const shown = shownShares[k];
      if (shown.of !== of) Object.assign(shown, { of, share: of >= 0 ? shareAround(isInside) : null });
      return shown.share;
    }).filter((share) => share);
  }

  // Lines where half of the surroundings are inside; a part of few vertices has less.
  function outline(mesh) {
    const lines = [], at = mesh.geometry.attributes.position.array;
    for (const share of sharesOfPicked()) {
      const level = Math.min(0.5, 0.8 * share.reduce((a, b) => Math.max(a, b), 0));
      for (let t = 0; t < triangles.length; t += 3) {
        for (let k = 0; k < 3; ++k) {
          const a = triangles[t + k], b = triangles[t + (k + 1) % 3];
          if (share[a] < level === share[b] < level) continue;
          const w = (level - share[a]) / (share[b] - share[a]);
          for (let c = 0; c < 3; ++c) lines.push(at[3 * a + c] + w * (at[3 * b + c] - at[3 * a + c]));
        }
      }
    }
    mesh.outline.geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(lines), 3));
    mesh.outline.geometry.computeBoundingSphere();
  }

  const single = makeMesh(1);
  let linked = null;  // source, target and difference
  function panels() {
    if (!byId('linked').checked) return [{ mesh: single, index: Number(byId('quantity').value), label: '' }];
    const find = (name) => record.quantities.findIndex((q) => q.name === name);
    if (!linked) linked = [makeMesh(0), makeMesh(1), makeMesh(1)];
    return record.linked.map(([name, label], i) => ({ mesh: linked[i], index: find(name), label }));
  }

  // Both states have one scale, so that they can be compared by eye.
  const ranges = record.quantities.map((q) => q.range);
  const states = record.quantities.map((q, i) => i).filter((i) => /^(?!deviation_|effective_samples_|trusted_).*_(source|target)$/.test(record.quantities[i].name));
  for (const i of states) ranges[i] = Math.max(...states.map((k) => record.quantities[k].range));
  function repaint() {
    const list = panels();
    for (const old of holder.querySelectorAll('.label')) old.remove();
    list.forEach((panel, i) => {
      paint(panel.mesh, panel.index, ranges[panel.index]);
      if (!panel.label) return;
      const label = add(holder, 'div', panel.label + ', \u00b1' + shown(ranges[panel.index]) + ' ' + record.quantities[panel.index].unit, 'label');
      label.style.left = (100 * i / list.length + 1) + '%';
      label.style.maxWidth = (100 / list.length - 2) + '%';  // a narrow one has two lines
    });
    const index = list[list.length - 1].index, quantity = record.quantities[index], range = ranges[index], scale = scaleOf(quantity);
    byId('range').value = shown(range);
    byId('unit').textContent = quantity.unit;
    byId('low').textContent = shown(quantity.signed ? -range : 0);
    byId('high').textContent = shown(range) + ' ' + quantity.unit;
    byId('untrusted').hidden = !record.cover.trusted || !compares(quantity);
    const isWhy = quantity.name === 'why';
    for (const id of ['scale', 'low', 'high', 'ranges', 'colour-maps']) byId(id).hidden = isWhy;
    byId('fades').hidden = isWhy || !doubt;
    byId('reasons').hidden = !isWhy;
    byId('unmatched').lastChild.textContent = isWhy ? record.unmatched_text : (record.cover.matched || {}).text || '';
    const context = byId('scale').getContext('2d');
    for (let x = 0; x < 256; ++x) {
      context.fillStyle = 'rgb(' + scale[Math.floor(x * scale.length / 256)].join(',') + ')';
      context.fillRect(x, 0, 1, 12);
    }
    draw();
  }

  function draw() {
    const width = holder.clientWidth, height = holder.clientHeight, list = panels();
    renderer.setSize(width, height, false);
    renderer.domElement.style.width = width + 'px';
    renderer.domElement.style.height = height + 'px';
    camera.aspect = width / list.length / height;
    camera.fov = 2 * Math.atan(Math.tan(15 * Math.PI / 180) / Math.min(1, camera.aspect)) * 180 / Math.PI;
    camera.updateProjectionMatrix();
    renderer.setScissorTest(true);
    list.forEach((panel, i) => {
      const x = Math.round(i * width / list.length), w = Math.round((i + 1) * width / list.length) - x;
      renderer.setViewport(x, 0, w, height);
      renderer.setScissor(x, 0, w, height);
      panel.mesh.light.position.copy(camera.position);
      panel.mesh.light.target.position.copy(controls.target);
      renderer.render(panel.mesh.scene, camera);
    });
  }

  function wholeView() {
    controls.target.copy(centre);
    camera.up.set(0, 1, 0);
    camera.position.copy(centre).add(new THREE.Vector3(0, 0, radius / Math.tan(15 * Math.PI / 180) * 0.85));
    controls.update();
    draw();
  }

  // ---- residues -------------------------------------------------------------------------------------------------

  const rows = record.residues.rows.map((cells, index) => ({ cells, index }));
  let column = Math.max(0, record.residues.columns.findIndex((c) => c.main)), descending = true;

  function fillTable() {
    const head = byId('residues').tHead, body = byId('residues').tBodies[0], word = byId('filter').value.toLowerCase();
    head.textContent = body.textContent = '';
    const line = add(head, 'tr');
    add(line, 'th', 'Residue').onclick = () => sortBy(-1);
    const others = record.residues.columns.map((c, i) => i).filter((i) => i === column || record.residues.columns[i].main);
    for (const i of others) {
      const c = record.residues.columns[i];
      add(line, 'th', c.label + (c.unit ? ' [' + c.unit + ']' : '') + (i === column ? (descending ? ' \u25be' : ' \u25b4') : '')).onclick = () => sortBy(i);
    }
    const size = (value) => (value === null ? -Infinity : Math.abs(value));
    const order = rows.filter((r) => record.residues.names[r.index].toLowerCase().includes(word));
    order.sort((a, b) => (column < 0 ? a.index - b.index : (size(b.cells[column]) - size(a.cells[column])) * (descending ? 1 : -1)) || a.index - b.index);
    for (const row of order) {
      const line = add(body, 'tr', undefined, row.index === picked ? 'picked' : '');
      add(line, 'td', record.residues.names[row.index]);
      for (const i of others) add(line, 'td', shown(row.cells[i]));
      line.onclick = () => pick(row.index, true);
    }
  }

  function sortBy(i) {
    descending = i === column ? !descending : true;
    column = i;
    if (i >= 0) byId('column').value = i;
    fillTable();
  }

  function pick(residue, fly) {
    picked = residue;
    for (const panel of panels()) outline(panel.mesh);
    fillTable();
    const texts = record.residues.columns.map((c, i) => c.main ? c.label + ' ' + shown(record.residues.rows[residue][i]) + ' ' + c.unit : '').filter((t) => t);
    byId('picked').textContent = record.residues.names[residue] + ': ' + texts.join(', ');
    const line = byId('residues').querySelector('.picked');
    if (line && !fly) line.scrollIntoView({ block: 'center' });
    if (fly) lookAt((v) => residueOf[v] === residue);
    draw();
  }

  function pickPatch(patch, fly) {
    pickedPatch = patch;
    for (const panel of panels()) outline(panel.mesh);
    Page.patches.show(patch);
    if (fly) lookAt((v) => patchOf[v] === patch + 1);
    draw();
  }

  // Turns a part of the surface to the front, at the present distance.
  function lookAt(isInside) {
    const sum = new THREE.Vector3(), at = single.geometry.attributes.position.array;
    let count = 0;
    for (let v = 0; v < n; ++v) {
      if (!isInside(v)) continue;
      sum.add(corner.set(at[3 * v], at[3 * v + 1], at[3 * v + 2]));
      ++count;
    }
    if (!count) return;
    const distance = camera.position.distanceTo(controls.target);
    controls.target.copy(centre);
    camera.position.copy(sum.divideScalar(count).sub(centre).normalize().multiplyScalar(distance).add(centre));
    controls.update();
  }

  // A vertex under the mouse, or -1.
  function vertexAt(event) {
    const box = renderer.domElement.getBoundingClientRect(), list = panels(), width = box.width / list.length;
    const x = event.clientX - box.left, i = Math.min(list.length - 1, Math.floor(x / width));
    const ray = new THREE.Raycaster();
    ray.setFromCamera({ x: 2 * (x - i * width) / width - 1, y: 1 - 2 * (event.clientY - box.top) / box.height }, camera);
    const hit = ray.intersectObject(list[i].mesh.surface)[0];
    return hit ? hit.face.a : -1;
  }

  // ---- what the user does ---------------------------------------------------------------------------------------

  record.quantities.forEach((q, i) => { add(byId('quantity'), 'option', q.label).value = i; });
  for (const name of record.diverging) add(byId('colours'), 'option', name).value = name;
  record.residues.columns.forEach((c, i) => { add(byId('column'), 'option', c.label).value = i; });
  byId('quantity').onchange = byId('colours').onchange = byId('fade').onchange = repaint;
  const has = (name) => record.quantities.some((q) => q.name === name);
  byId('unmatched').hidden = !record.cover.matched;
  for (const { text, colour } of reasons.filter((reason) => reason.text)) {
    const key = add(byId('reasons'), 'span');
    add(key, 'i').style.background = 'rgb(' + colour.join(',') + ')';
    key.append(' ' + text);
  }
  byId('untrusted').lastChild.textContent = (record.cover.trusted || {}).text || '';
  byId('links').hidden = !record.linked || !record.linked.every(([name]) => has(name));
  byId('link-text').textContent = (record.linked || []).map(([, label]) => label).join(', ');
  byId('fade-text').textContent = fade ? fade.text : '';
  byId('morphs').hidden = source === target;
  byId('molecules').hidden = !record.backbone && !record.molecule_because;
  byId('molecule').disabled = !record.backbone;
  byId('molecules').title = record.molecule_because || '';
  byId('molecule').onchange = () => { for (const mesh of [single, ...linked || []]) showMolecule(mesh); draw(); };
  byId('linked').onchange = () => { repaint(); for (const panel of panels()) outline(panel.mesh); draw(); };
  byId('range').onchange = () => {
    const value = Number(byId('range').value), list = panels();
    if (value > 0) ranges[list[list.length - 1].index] = value;
    repaint();
  };
  byId('morph').oninput = () => { place(single, Number(byId('morph').value)); draw(); };
  byId('column').onchange = () => { column = -2; sortBy(Number(byId('column').value)); };
  byId('filter').oninput = fillTable;
  byId('home').onclick = wholeView;
  byId('save').onclick = () => {
    draw();
    const link = document.createElement('a');
    link.href = renderer.domElement.toDataURL('image/png');
    link.download = record.title.replace(/[^A-Za-z0-9_.-]+/g, '_') + '.png';
    link.click();
  };
  // Not click: the controls turn it off for fingers.
  let down = null;
  renderer.domElement.addEventListener('pointerdown', (event) => { down = event.isPrimary && event.button === 0 ? [event.clientX, event.clientY] : null; });
  renderer.domElement.addEventListener('pointerup', (event) => {
    if (!down || Math.hypot(event.clientX - down[0], event.clientY - down[1]) > (event.pointerType === 'touch' ? 10 : 3)) return;
    down = null;
    const vertex = vertexAt(event), residue = vertex < 0 ? -1 : residueOf[vertex];
    if (residue >= 0 && residue < rows.length) pick(residue, false);
    if (vertex >= 0 && patchOf && patchOf[vertex] > 0) pickPatch(patchOf[vertex] - 1, false);
  });
  controls.addEventListener('change', draw);
  window.addEventListener('resize', () => { controls.handleResize(); draw(); });
  (function turn() { requestAnimationFrame(turn); controls.update(); })();
  controls.handleResize();
  byId('column').value = column;
  fillTable();
  wholeView();
  repaint();
  if (patchOf) {
    Page.patches.showTable((k) => pickPatch(k, true));
    if (record.patches.length) pickPatch(0, true);
  }
  document.documentElement.dataset.ready = 'yes';
})();
