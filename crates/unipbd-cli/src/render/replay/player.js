"use strict";
// Plays the frames of a run. The format is that of replay/mod.rs.
(async () => {
  const element = (id) => document.getElementById(id);
  const head = JSON.parse(element("head").textContent);
  const packed = Uint8Array.from(atob(element("data").textContent), (letter) => letter.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
  const frames = decode(new DataView(await new Response(stream).arrayBuffer()));
  const times = head.times;
  const [start, end] = [times[0], times[times.length - 1]];

  // Frames: positions in quanta, where each particle was in the frame before, materials, columns, poses of bodies.
  function decode(view) {
    const frames = [];
    let at = 0;
    const take = (count) => {
      const bytes = new Uint8Array(view.buffer, at, count);
      at += count;
      return bytes;
    };
    for (let number = 0; number < head.times.length; number++) {
      const before = frames[number - 1];
      const count = view.getUint32(at, true);
      const fresh = view.getUint8(at + 4) === 1;
      at += 5;
      let from = null;
      let materials = before && before.materials;
      if (fresh) {
        from = new Uint32Array(count);
        let before = 0xffffffff;
        for (let row = 0; row < count; row++) before = from[row] = (before + 1 + view.getUint32(at + 4 * row, true)) >>> 0;
        at += 4 * count;
        materials = take(count);
      }
      const frame = { count, from, materials, places: [], columns: [] };
      for (let axis = 0; axis < 2; axis++) {
        const [low, high] = [take(count), take(count)];
        const places = new Int16Array(count);
        for (let row = 0; row < count; row++) {
          const folded = low[row] | (high[row] << 8);
          const residual = folded & 1 ? ~(folded >> 1) : folded >> 1;
          places[row] = expected(before, frames[number - 2], from, axis, row) + residual;
        }
        frame.places.push(places);
      }
      for (let column = 0; column < head.columns.length; column++) frame.columns.push(take(count));
      frame.bodies = new Float32Array(3 * head.bodies.length);
      for (let part = 0; part < frame.bodies.length; part++) frame.bodies[part] = view.getFloat32(at + 4 * part, true);
      at += 4 * frame.bodies.length;
      frames.push(frame);
    }
    return frames;
  }

  // A particle goes on as it went; one that is new starts at the middle.
  function expected(before, earlier, from, axis, row) {
    const one = from ? from[row] : row;
    if (!before || one === 0xffffffff) return 0;
    const two = before.from ? before.from[one] : one;
    const place = before.places[axis][one];
    return earlier && two !== 0xffffffff ? 2 * place - earlier.places[axis][two] : place;
  }

  const canvas = element("view");
  const pen = canvas.getContext("2d");
  document.title = head.name || "unipbd";
  document.body.style.background = head.background;
  document.body.style.color = head.text;

  const shows = [{ name: "material" }, { name: "speed", unit: "m/s" }, ...head.columns];
  for (const show of shows) element("color").add(new Option(show.name));
  let shown = 0;
  let range = [0, 1];

  // One disc per colour, drawn once for each size of the window.
  let sprites = [];
  let camera = null;
  function fit() {
    const ratio = window.devicePixelRatio || 1;
    canvas.width = Math.max(1, Math.round(canvas.clientWidth * ratio));
    canvas.height = Math.max(1, Math.round(canvas.clientHeight * ratio));
    const [x0, y0, x1, y1] = head.view;
    const scale = Math.min(canvas.width / (x1 - x0), canvas.height / (y1 - y0));
    const left = 0.5 * (canvas.width - scale * (x1 - x0)) - scale * x0;
    const base = 0.5 * (canvas.height + scale * (y1 - y0)) + scale * y0;
    camera = { scale, left, base };
    const radius = Math.max(0.55 * head.spacing * scale, 0.7);
    const colors = shown === 0 ? head.materials.map((material) => material.color) : head.ramp;
    sprites = colors.map((color) => {
      const disc = document.createElement("canvas");
      disc.width = disc.height = 2 * Math.ceil(radius + 1);
      const ink = disc.getContext("2d");
      ink.fillStyle = color;
      ink.beginPath();
      ink.arc(disc.width / 2, disc.width / 2, radius, 0, 7);
      ink.fill();
      return disc;
    });
  }

  function speedRange() {
    let most = 0;
    for (let number = 1; number < frames.length; number += Math.max(1, frames.length >> 4)) {
      const values = [];
      for (let row = 0; row < frames[number].count; row++) values.push(speed(number, row));
      values.sort((a, b) => a - b);
      if (values.length) most = Math.max(most, values[Math.floor(0.995 * (values.length - 1))]);
    }
    return [0, Number((most || 1).toPrecision(2))];
  }

  function speed(number, row) {
    const [frame, before] = [frames[number], frames[number - 1]];
    const old = frame.from ? frame.from[row] : row;
    if (!before || old === 0xffffffff) return 0;
    const dx = frame.places[0][row] - before.places[0][old];
    const dy = frame.places[1][row] - before.places[1][old];
    return Math.hypot(dx, dy) * head.quantum / (times[number] - times[number - 1]);
  }

  function color(number, row) {
    const frame = frames[number];
    if (shown === 0) return frame.materials[row];
    const top = sprites.length - 1;
    if (shown > 1) return Math.round(frame.columns[shown - 2][row] / 255 * top);
    return Math.round(Math.min(1, speed(Math.max(number, 1), row) / range[1]) * top) || 0;
  }

  function draw(time) {
    let number = times.findIndex((other) => other > time) - 1;
    if (number < 0) number = times.length - 1;
    const next = number + 1 < frames.length && !frames[number + 1].from ? frames[number + 1] : null;
    const part = next ? (time - times[number]) / (times[number + 1] - times[number]) : 0;
    const between = (a, b) => (next ? a + (b - a) * part : a);
    const frame = frames[number];
    pen.setTransform(1, 0, 0, 1, 0, 0);
    pen.fillStyle = head.background;
    pen.fillRect(0, 0, canvas.width, canvas.height);
    const { scale, left, base } = camera;
    const quanta = scale * head.quantum;
    for (const layer of head.layers) {
      pen.save();
      if (layer.soft && head.region.length) {
        pen.beginPath();
        for (const corners of head.region) {
          corners.forEach(([x, y], k) => pen[k ? "lineTo" : "moveTo"](x * scale + left, base - y * scale));
          pen.closePath();
        }
        pen.clip();
      }
      pen.globalAlpha = layer.opacity;
      for (let row = 0; row < frame.count; row++) {
        if (!layer.materials.includes(frame.materials[row])) continue;
        const disc = sprites[color(number, row)];
        const x = between(frame.places[0][row], next && next.places[0][row]) * quanta + left + scale * head.middle[0];
        const y = base - scale * head.middle[1] - between(frame.places[1][row], next && next.places[1][row]) * quanta;
        pen.drawImage(disc, x - disc.width / 2, y - disc.width / 2);
      }
      pen.restore();
    }
    pen.globalAlpha = 1;
    pen.lineWidth = Math.max(1.5, 0.002 * canvas.width);
    pen.strokeStyle = head.walls.color;
    for (const wall of head.walls.lines) {
      pen.beginPath();
      for (const [x, y] of wall.points) pen.lineTo(x * scale + left, base - y * scale);
      if (wall.closed) pen.closePath();
      pen.stroke();
    }
    head.bodies.forEach((body, index) => {
      const pose = [0, 1, 2].map((k) => between(frame.bodies[3 * index + k], next && next.bodies[3 * index + k]));
      if (pose.every((value) => Number.isFinite(value))) drawBody(body, pose);
    });
    element("time").textContent = `${time.toFixed(2)} s`;
  }

  function drawBody(body, [x, y, angle]) {
    const { scale, left, base } = camera;
    const [cos, sin] = [scale * Math.cos(angle), scale * Math.sin(angle)];
    pen.setTransform(cos, -sin, -sin, -cos, x * scale + left, base - y * scale);
    pen.beginPath();
    if (body.radius > 0) {
      pen.arc(0, 0, body.radius, 0, 7);
      pen.moveTo(0, 0);
      pen.lineTo(0.72 * body.radius, 0);
    } else {
      for (const [px, py] of body.outline) pen.lineTo(px, py);
      pen.closePath();
    }
    pen.setTransform(1, 0, 0, 1, 0, 0);
    pen.fillStyle = body.color;
    pen.fill();
    pen.strokeStyle = body.edge;
    pen.stroke();
  }

  let now = start;
  let playing = frames.length > 1;
  let last = null;
  const seek = element("seek");
  [seek.min, seek.max] = [start, end];
  const update = () => {
    seek.value = now;
    element("play").textContent = playing ? "\u275a\u275a" : "\u25b6";
    draw(now);
  };
  const toggle = () => {
    playing = !playing;
    if (playing && now >= end) now = start;
    update();
  };
  const recolor = () => {
    shown = element("color").selectedIndex;
    range = shown === 1 ? speedRange() : shown > 1 ? head.columns[shown - 2].range : [0, 1];
    element("scale").style.display = shown ? "flex" : "none";
    element("low").textContent = range[0];
    element("high").textContent = `${range[1]} ${shows[shown].unit || ""}`;
    const ramp = element("ramp").getContext("2d");
    head.ramp.forEach((one, k) => {
      ramp.fillStyle = one;
      ramp.fillRect(k / head.ramp.length * 90, 0, 90, 1);
    });
    fit();
    update();
  };
  seek.addEventListener("input", () => {
    [now, playing] = [Number(seek.value), false];
    update();
  });
  element("play").addEventListener("click", toggle);
  element("color").addEventListener("change", recolor);
  addEventListener("keydown", (event) => {
    if (["SELECT", "INPUT"].includes(event.target.tagName) && event.key !== " ") return;
    const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (event.key === " ") {
      event.preventDefault();
      toggle();
    } else if (step) {
      const number = times.findLastIndex((time) => time <= now + 1e-6) + step;
      [now, playing] = [times[Math.min(Math.max(number, 0), times.length - 1)], false];
      update();
    }
  });
  addEventListener("resize", () => {
    fit();
    update();
  });
  const tick = (stamp) => {
    if (playing) {
      now += last === null ? 0 : (stamp - last) / 1000 * Number(element("speed").value);
      if (now >= end) [now, playing] = [end, false];
      update();
    }
    last = stamp;
    requestAnimationFrame(tick);
  };
  recolor();
  requestAnimationFrame(tick);
  window.replay = { show: (time) => { [now, playing] = [time, false]; update(); }, frames, head };
})();
