// ribbon.js: the backbone of a molecule as ribbons: wide in the direction of the C=O bonds, smooth through the C-alphas.
'use strict';
Page.ribbon = (() => {
  const halfWidth = 1.0, steps = 6;  // Angstrom; pieces of ribbon a residue

  // Between the source's backbone (0) and the target's (1) where both have the same stretches, otherwise the nearer one.
  function between(morph) {
    const { source, target } = Page.record.backbone, same = source.chains.join() === target.chains.join();
    const near = morph < 0.5 ? source : target, points = Page.decode(near.points), sides = Page.decode(near.sides);
    if (!same) return { chains: near.chains, points, sides };
    const from = Page.decode(source.points), to = Page.decode(target.points);
    return { chains: near.chains, points: from.map((x, i) => x + morph * (to[i] - x)), sides };
  }

  function vectors(numbers, begin, n) {
    return Array.from({ length: n }, (_, i) => new THREE.Vector3().fromArray(numbers, 3 * (begin + i)));
  }

  // Consecutive C=O bonds point to opposite sides in a strand: turned so that none points against the one before.
  function aligned(sides) {
    let last = null;
    return sides.map((side) => {
      if (side.lengthSq() < 0.1) return last ? last.clone() : side;
      if (last && side.dot(last) < 0) side.negate();
      return last = side;
    });
  }

  // Adds a strip along one unbroken stretch.
  function strip(points, sides, positions, index) {
    if (points.length < 2) return;
    const curve = new THREE.CatmullRomCurve3(points), n = (points.length - 1) * steps, first = positions.length / 3;
    for (let i = 0; i <= n; ++i) {
      const at = i / steps, k = Math.min(points.length - 2, Math.floor(at)), t = at - k;
      const place = curve.getPoint(i / n), along = curve.getTangent(i / n);
      const side = sides[k].clone().multiplyScalar(1 - t).addScaledVector(sides[k + 1], t);
      side.addScaledVector(along, -side.dot(along));
      if (side.lengthSq() < 1e-3) side.set(along.y, along.z, along.x).cross(along);
      side.normalize().multiplyScalar(halfWidth);
      positions.push(place.x + side.x, place.y + side.y, place.z + side.z, place.x - side.x, place.y - side.y, place.z - side.z);
      const a = first + 2 * i;
      if (i < n) index.push(a, a + 1, a + 2, a + 1, a + 3, a + 2);
    }
  }

  // The geometry of all stretches.
  return function (morph) {
    const { chains, points, sides } = between(morph), positions = [], index = [];
    let begin = 0;
    for (const n of chains) {
      strip(vectors(points, begin, n), aligned(vectors(sides, begin, n)), positions, index);
      begin += n;
    }
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(positions), 3));
    geometry.setIndex(index);
    geometry.computeVertexNormals();
    return geometry;
  };
})();
