"use strict";
// The page's own script: a table that sorts, and a view of the shots that turns. No library, no network.
(() => {
  const data = JSON.parse(document.getElementById("data").textContent);
  const shots = data.shots;
  // A mirror image has the path of its other side.
  for (const shot of shots) {
    if (shot.mirror_of === undefined) continue;
    Object.defineProperty(shot, "path", { get: () => shots[shot.mirror_of].path.map(([t, x, y, z]) => [t, x, -y, z]) });
  }
  const canvas = document.getElementById("view");
  const shown = document.getElementById("shown");
  const timeSlider = document.getElementById("time");
  const placeSlider = document.getElementById("place");
  const kindBox = document.getElementById("kind");
  const playButton = document.getElementById("play");
  const context = canvas.getContext("2d");
  const COLOURS = { direct: "#0072b2", bank: "#b85c00" };
  const places = [...new Set(shots.map((shot) => shot.place))];
  const state = { place: 0, kind: "both", time: 1, azimuth: 0.9, elevation: 0.35, zoom: 1, playing: false };

  const atPlace = () => shots.filter((shot) => shot.place === places[state.place]);
  const current = () => {
    const here = atPlace();
    const chosen = here.filter((shot) => state.kind === "both" || shot.kind === state.kind);
    return chosen.length > 0 ? chosen : here;
  };

  // The court as lines in space, m; the floor is the hoop's height below the ring.
  const floor = -data.court.hoop_height_m;
  const arc = (x, radius, from, to) => {
    const points = [];
    for (let i = 0; i <= 48; i++) {
      const angle = from + ((to - from) * i) / 48;
      points.push([x + radius * Math.cos(angle), radius * Math.sin(angle), floor]);
    }
    return points;
  };
  const court = data.court;
  const turn = Math.atan2(court.three_corner_y_m, court.three_break_x_m);
  const lane = court.lane_half_width_m;
  const base = court.baseline_x_m;
  const far = Math.min(court.half_line_x_m, Math.max(court.three_radius_m + 1.2, data.far_x_m + 1.2));
  const wide = court.half_width_m;
  const lines = [
    [[base, -wide, floor], [far, -wide, floor], [far, wide, floor], [base, wide, floor], [base, -wide, floor]],
    [[base, -lane, floor], [court.free_throw_x_m, -lane, floor], [court.free_throw_x_m, lane, floor], [base, lane, floor]],
    arc(court.free_throw_x_m, court.circle_radius_m, -Math.PI / 2, Math.PI / 2),
    arc(0, court.restricted_radius_m, -Math.PI / 2, Math.PI / 2),
    [[base, -court.three_corner_y_m, floor], ...arc(0, court.three_radius_m, -turn, turn), [base, court.three_corner_y_m, floor]],
  ];
  const face = -court.board_distance_m;
  const half = court.board_width_m / 2;
  const low = court.board_centre_height_m - court.board_height_m / 2;
  const high = court.board_centre_height_m + court.board_height_m / 2;
  const board = [[face, -half, low], [face, half, low], [face, half, high], [face, -half, high], [face, -half, low]];
  // Where the rounded edge, padding included, begins.
  const edge = court.board_edge_radius_m;
  const inner = [[face, edge - half, low + edge], [face, half - edge, low + edge], [face, half - edge, high - edge], [face, edge - half, high - edge], [face, edge - half, low + edge]];
  const side = court.bracket_width_m / 2;
  const bracket = [[face, -side, 0], [-court.ring_radius_m, -side, 0], [-court.ring_radius_m, side, 0], [face, side, 0]];
  const ring = arc(0, court.ring_radius_m, 0, 2 * Math.PI).map(([x, y]) => [x, y, 0]);

  // From space to the canvas, by a camera that looks at a point between the hoop and the shooter.
  const camera = () => {
    const here = current()[0];
    const middle = here ? [here.x_m * 0.4, here.y_m * 0.4, floor * 0.35] : [2, 0, floor * 0.35];
    const reach = here ? Math.max(4.5, Math.hypot(here.x_m, here.y_m)) : 6;
    const distance = (reach * 2.1 + 2) / state.zoom;
    const [sa, ca] = [Math.sin(state.azimuth), Math.cos(state.azimuth)];
    const [se, ce] = [Math.sin(state.elevation), Math.cos(state.elevation)];
    const scale = Math.min(canvas.width, canvas.height * 1.5) * 0.95;
    return ([x, y, z]) => {
      const [dx, dy, dz] = [x - middle[0], y - middle[1], z - middle[2]];
      const right = -sa * dx + ca * dy;
      const ahead = distance - (ca * ce * dx + sa * ce * dy + se * dz);
      const up = -ca * se * dx - sa * se * dy + ce * dz;
      if (ahead < 0.1) return null;
      return [canvas.width / 2 + (scale * right) / ahead, canvas.height / 2 - (scale * up) / ahead, scale / ahead];
    };
  };

  const stroke = (project, points, style, width) => {
    context.beginPath();
    let down = false;
    for (const point of points) {
      const at = project(point);
      if (!at) { down = false; continue; }
      if (down) context.lineTo(at[0], at[1]); else context.moveTo(at[0], at[1]);
      down = true;
    }
    context.strokeStyle = style;
    context.lineWidth = width * devicePixelRatio;
    context.stroke();
  };

  const ballAt = (path, part) => {
    const time = part * path[path.length - 1][0];
    let i = 1;
    while (i < path.length - 1 && path[i][0] < time) i++;
    const [a, b] = [path[i - 1], path[i]];
    const share = b[0] > a[0] ? Math.min(1, Math.max(0, (time - a[0]) / (b[0] - a[0]))) : 1;
    return [1, 2, 3].map((k) => a[k] + share * (b[k] - a[k]));
  };

  const draw = () => {
    const box = canvas.getBoundingClientRect();
    canvas.width = Math.max(1, Math.round(box.width * devicePixelRatio));
    canvas.height = Math.max(1, Math.round(box.height * devicePixelRatio));
    context.clearRect(0, 0, canvas.width, canvas.height);
    const project = camera();
    for (const line of lines) stroke(project, line, "#9a9a92", 1.2);
    stroke(project, board, "#333333", 2.5);
    stroke(project, [[face, 0, low], [base * 0.9, 0, low], [base * 0.9, 0, floor]], "#bbbbbb", 3);
    if (edge > 0) stroke(project, inner, "#999999", 1);
    if (side > 0) stroke(project, bracket, "#d55e00", 1.5);
    stroke(project, ring, "#d55e00", 3);
    for (const shot of current()) {
      stroke(project, shot.path.map(([, x, y]) => [x, y, floor]), "rgba(0,0,0,0.18)", 1.5);
      stroke(project, shot.path.map(([, x, y, z]) => [x, y, z]), COLOURS[shot.kind] || "#333", 2);
      const ball = project(ballAt(shot.path, state.time));
      if (ball) {
        context.beginPath();
        context.arc(ball[0], ball[1], Math.max(2, court.ball_radius_m * ball[2]), 0, 2 * Math.PI);
        context.fillStyle = "#d9822b";
        context.fill();
        context.strokeStyle = COLOURS[shot.kind] || "#333";
        context.lineWidth = 1.5 * devicePixelRatio;
        context.stroke();
      }
    }
  };

  const tell = () => {
    const here = current();
    const where = data.places_are ? (here) => `${here}: ` : (here) => `From ${here}. `;
    const from = places.length > 1 && here.length > 0 ? where(here[0].where) : "";
    shown.textContent = from + here.map((shot) => shot.words).join(" ");
    canvas.setAttribute("aria-label", `The flight of the ball, to be turned with the arrow keys. ${shown.textContent}`);
    for (const row of document.querySelectorAll("tr[data-shot]")) {
      row.classList.toggle("chosen", here.includes(shots[Number(row.dataset.shot)]));
    }
    document.getElementById("place-name").textContent = here.length > 0 ? here[0].where : "";
    draw();
  };

  // Playing: the flight in its own time.
  let began = 0;
  const step = (now) => {
    if (!state.playing) return;
    const longest = Math.max(...current().map((shot) => shot.path[shot.path.length - 1][0]));
    state.time = Math.min(1, (now - began) / 1000 / longest);
    timeSlider.value = String(Math.round(1000 * state.time));
    draw();
    if (state.time < 1) requestAnimationFrame(step); else play(false);
  };
  const play = (on) => {
    state.playing = on;
    playButton.textContent = on ? "Stop" : "Play";
    playButton.setAttribute("aria-pressed", String(on));
    if (on) { began = performance.now(); requestAnimationFrame(step); }
  };

  playButton.addEventListener("click", () => play(!state.playing));
  timeSlider.addEventListener("input", () => { play(false); state.time = Number(timeSlider.value) / 1000; draw(); });
  placeSlider.max = String(places.length - 1);
  placeSlider.addEventListener("input", () => { state.place = Number(placeSlider.value); tell(); });
  if (places.length < 2) placeSlider.closest("label").hidden = true;
  if (data.places_are) document.getElementById("places-are").textContent = data.places_are;
  kindBox.addEventListener("change", () => { state.kind = kindBox.value; tell(); });
  if (new Set(shots.map((shot) => shot.kind)).size < 2) kindBox.closest("label").hidden = true;

  let drag = null;
  canvas.addEventListener("pointerdown", (event) => { drag = [event.clientX, event.clientY]; canvas.setPointerCapture(event.pointerId); });
  canvas.addEventListener("pointermove", (event) => {
    if (!drag) return;
    turnBy((event.clientX - drag[0]) * 0.01, (event.clientY - drag[1]) * 0.01);
    drag = [event.clientX, event.clientY];
  });
  for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, () => { drag = null; });
  canvas.addEventListener("wheel", (event) => { event.preventDefault(); zoomBy(Math.exp(-event.deltaY * 0.001)); }, { passive: false });
  const turnBy = (azimuth, elevation) => {
    state.azimuth -= azimuth;
    state.elevation = Math.min(1.55, Math.max(-0.1, state.elevation + elevation));
    draw();
  };
  const zoomBy = (times) => { state.zoom = Math.min(6, Math.max(0.4, state.zoom * times)); draw(); };
  canvas.addEventListener("keydown", (event) => {
    const turns = { ArrowLeft: [0.1, 0], ArrowRight: [-0.1, 0], ArrowUp: [0, 0.1], ArrowDown: [0, -0.1] };
    if (turns[event.key]) turnBy(...turns[event.key]);
    else if (event.key === "+") zoomBy(1.2);
    else if (event.key === "-") zoomBy(1 / 1.2);
    else if (event.key === " ") play(!state.playing);
    else return;
    event.preventDefault();
  });
  addEventListener("resize", draw);
  // On a narrow screen a figure fits the width; a tap enlarges it.
  for (const figure of document.querySelectorAll("figure")) figure.addEventListener("click", () => figure.classList.toggle("enlarged"));
  addEventListener("beforeprint", draw);

  // Tables: a column's name sorts by it, again the other way.
  for (const table of document.querySelectorAll("table.sortable")) {
    const heads = [...table.tHead.rows[0].cells];
    heads.forEach((head, column) => {
      head.querySelector("button").addEventListener("click", () => {
        const down = head.getAttribute("aria-sort") === "ascending";
        heads.forEach((other) => other.removeAttribute("aria-sort"));
        head.setAttribute("aria-sort", down ? "descending" : "ascending");
        const value = (row) => row.cells[column].dataset.value ?? row.cells[column].textContent;
        const compare = (a, b) => {
          const [x, y] = [value(a), value(b)];
          const [p, q] = [Number(x), Number(y)];
          const order = x !== "" && y !== "" && !Number.isNaN(p) && !Number.isNaN(q) ? p - q : x.localeCompare(y);
          return down ? -order : order;
        };
        table.tBodies[0].append(...[...table.tBodies[0].rows].sort(compare));
      });
    });
    table.tBodies[0].addEventListener("click", (event) => {
      const row = event.target.closest("tr[data-shot]");
      if (!row) return;
      state.place = places.indexOf(shots[Number(row.dataset.shot)].place);
      placeSlider.value = String(state.place);
      tell();
    });
  }

  // Nothing to choose, nothing to tell apart.
  if (new Set(shots.map((shot) => shot.kind)).size < 2) {
    kindBox.closest("label").hidden = true;
    document.getElementById("colours").hidden = true;
  }
  state.place = Math.max(0, places.indexOf(data.first_place));
  placeSlider.value = String(state.place);
  const first = current()[0];
  if (first) state.azimuth = Math.atan2(first.y_m, first.x_m) + 0.75;
  tell();
  // For those who look after the page: what it shows.
  window.bankshot = { state, shots, places };
})();
