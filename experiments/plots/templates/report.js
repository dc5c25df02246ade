"use strict";
const data = JSON.parse(document.getElementById("data").textContent);
const dark = matchMedia("(prefers-color-scheme: dark)");
const get = (selector, within = document) => within.querySelector(selector);
const all = (selector, within = document) => [...within.querySelectorAll(selector)];
const short = value => typeof value === "number" ? String(Number(value.toPrecision(4))) : String(value);
const colour_of = series => data.styles[series][dark.matches ? "dark" : "light"];

function add(parent, tag, text, attributes = {}) {
  const element = document.createElement(tag);
  if (text !== undefined) element.textContent = text;
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  parent.append(element);
  return element;
}

// ---- Colour and marker of each technique, beside its name
function draw_marks() {
  for (const cell of all("[data-series]")) {
    const style = data.styles[cell.dataset.series];
    if (!style) continue;
    const old = get("canvas", cell);
    const canvas = old || document.createElement("canvas");
    if (!old) cell.prepend(canvas);
    Object.assign(canvas, { width: 28, height: 28, className: "swatch" });
    Object.assign(canvas.style, { width: "14px", height: "14px" });
    const context = canvas.getContext("2d");
    context.strokeStyle = context.fillStyle = colour_of(cell.dataset.series);
    context.lineWidth = 4;
    Chart.helpers.drawPoint(context, { pointStyle: style.point, rotation: style.rotation, radius: 10, borderWidth: 4 }, 14, 14);
  }
}

// ---- Tables: sort by a column, filter by words
function sort_by(header) {
  const table = header.closest("table"), body = table.tBodies[0], column = header.cellIndex;
  const descending = header.getAttribute("aria-sort") === "ascending";
  const value = row => row.cells[column].dataset.sort ?? row.cells[column].textContent;
  const numeric = [...body.rows].every(row => value(row) === "" || !isNaN(value(row)));
  const compare = (a, b) => {
    if (value(a) === "" || value(b) === "") return (value(a) === "") - (value(b) === ""); // unknown ones stay last
    const order = numeric ? value(a) - value(b) : value(a).localeCompare(value(b));
    return descending ? -order : order;
  };
  body.append(...[...body.rows].sort(compare));
  for (const other of table.tHead.rows[0].cells) other.removeAttribute("aria-sort");
  header.setAttribute("aria-sort", descending ? "descending" : "ascending");
}

function filter_rows(input) {
  const words = input.value.toLowerCase().split(/\s+/);
  for (const row of get("tbody", input.closest(".table")).rows)
    row.hidden = !words.every(word => row.textContent.toLowerCase().includes(word));
}

// ---- One run: everything that is known of it
function show_run(id) {
  const run = data.runs[id], dialog = get("#run");
  if (!run) return;
  get("h2", dialog).textContent = run.name;
  const command = get(".command", dialog);
  command.replaceChildren();
  for (const [said, line] of run.commands) {
    add(command, "span", said + " ", { class: "note" });
    add(command, "code", line);
    add(command, "br");
  }
  const shown = get(".shown", dialog);
  shown.replaceChildren(...all(`.shot[data-run="${id}"] figure`).map(figure => figure.cloneNode(true)));
  if (!shown.children.length && run.picture) add(shown, "p", `Pictures: ${run.picture} beside this report's file`, { class: "note" });
  const table = get("table", dialog);
  table.replaceChildren();
  run.values.forEach((value, i) => {
    if (value === null) return;
    const row = add(table, "tr");
    add(row, "td", data.columns[i]);
    add(row, "td", short(value));
    add(row, "td", data.units[i]);
  });
  dialog.showModal();
  dialog.scrollTop = 0;
}

// ---- What accuracy costs
let chart = null;

function points_of(frame, measure, cost) {
  const series = new Map();
  for (const [id, run] of Object.entries(data.runs)) {
    const y = run.errors[measure], x = run.costs[cost];
    if (run.frame !== frame || y === undefined || !(x > 0)) continue;
    if (!series.has(run.series)) series.set(run.series, []);
    series.get(run.series).push({ x, y: Math.max(y, run.floor), exact: y, id });
  }
  for (const points of series.values()) points.sort((a, b) => a.x - b.x);
  return series;
}

function front_of(series) {
  const front = [];
  for (const point of [...series.values()].flat().sort((a, b) => a.x - b.x || a.y - b.y))
    if (!front.length || point.y < front.at(-1).y) front.push(point);
  return front;
}

function datasets_of(series) {
  const sets = [...series].map(([label, points]) => {
    const style = data.styles[label], colour = colour_of(label);
    return { label, data: points, borderColor: colour, backgroundColor: colour, borderDash: style.dash, borderWidth: 1.3, showLine: !data.cloud[label],
      pointStyle: style.point, pointRotation: style.rotation, radius: 5, hoverRadius: 8, pointBorderWidth: 2 };
  });
  const front = front_of(series), end = Math.max(...[...series.values()].flat().map(point => point.x));
  if (front.length) front.push({ x: end, y: front.at(-1).y });
  sets.push({ label: "Pareto front", data: front, borderColor: "#8888", borderWidth: 6, showLine: true, stepped: "before", pointRadius: 0, pointHitRadius: 0, order: 9 });
  return sets;
}

function told(point) {
  const run = data.runs[point.id];
  return [run.name, `${short(100 * point.exact)} % wrong, ${run.time}`, `${short(run.costs.fetches ?? NaN)} fetches a ray`, "click for the run"];
}

function draw_curve() {
  const frame = get("#curve-frame").value, measure = get("#curve-measure").value, cost = get("#curve-cost").value;
  const style = getComputedStyle(document.documentElement), text = style.getPropertyValue("--text"), line = style.getPropertyValue("--line");
  const series = points_of(frame, measure, cost), drawn = [...series.values()].flat();
  const axis = (title, values) => ({ type: "logarithmic", min: 0.8 * Math.min(...values), max: 1.25 * Math.max(...values), title: { display: true, text: title, color: text }, grid: { color: line },
    ticks: { color: text, maxTicksLimit: 9, callback: value => /^[125]0*$/.test(String(value).replace(/^[0.]+/, "")) ? short(value) : null } });
  if (chart) chart.destroy();
  chart = new Chart(get("#curve-canvas"), {
    type: "scatter",
    data: { datasets: datasets_of(series) },
    options: {
      maintainAspectRatio: false, animation: false,
      scales: { x: axis(data.costs[cost], drawn.map(one => one.x)), y: axis(data.errors[measure], drawn.map(one => one.y)) },
      plugins: {
        legend: { position: "bottom", labels: { usePointStyle: true, color: text, boxHeight: 8 } },
        tooltip: { filter: item => item.raw.id !== undefined, callbacks: { label: item => told(item.raw) } },
      },
      onClick: (_, elements) => {
        const point = elements.map(one => chart.data.datasets[one.datasetIndex].data[one.index]).find(one => one.id);
        if (point) show_run(point.id);
      },
      onHover: (event, elements) => { event.native.target.style.cursor = elements.length ? "pointer" : ""; },
    },
  });
  const finding = data.findings[frame] || "";
  get("#curve-canvas").setAttribute("aria-label", `${data.errors[measure]} against ${data.costs[cost]}, ${frame}. ${finding}`);
}

function prepare_curve() {
  if (!get("#curve")) return;
  const runs = Object.values(data.runs);
  const fill = (id, entries) => {
    for (const [value, said] of entries) add(get(id), "option", said, { value });
    get(id).addEventListener("change", draw_curve);
  };
  fill("#curve-frame", [...new Set(runs.map(run => run.frame))].map(frame => [frame, frame]));
  fill("#curve-measure", Object.entries(data.errors).filter(([name]) => runs.some(run => run.errors[name] !== undefined)));
  fill("#curve-cost", Object.entries(data.costs).filter(([name]) => runs.some(run => run.costs[name] > 0)));
  draw_curve();
  addEventListener("beforeprint", () => chart.resize());
  addEventListener("afterprint", () => chart.resize());
}

// ---- The ray of a pixel of the shown pictures
function show_pixel(compare, x, y, picture, other) {
  const run = data.runs[(picture.closest("[data-run]") || other.closest("[data-run]"))?.dataset.run];
  if (!run) return;
  const pixel = [x, y].map((share, i) => Math.min(run.size[i] - 1, Math.max(0, Math.floor(share * run.size[i]))));
  const told = get(".pixel", compare), spot = get(".spot", compare);
  get("code", told).textContent = `${run.ray} --pixel ${pixel}`;
  get("button", told).textContent = "Copy";
  Object.assign(spot.style, { left: `${100 * x}%`, top: `${100 * y}%` });
  told.hidden = spot.hidden = false;
}

function copy_command(button) {
  const command = get("code", button.parentNode);
  getSelection().selectAllChildren(command); // where a page may not write to the clipboard
  navigator.clipboard?.writeText(command.textContent).then(() => { button.textContent = "Copied"; }, () => {});
}

// ---- Pictures side by side under a slider
function prepare_compare(compare) {
  const pictures = all(".shots img", compare.closest("section"));
  const stage = get(".stage", compare), slider = get("input[type=range]", compare);
  const place = () => {
    get(".right", stage).style.clipPath = `inset(0 0 0 ${slider.value}%)`;
    get(".edge", stage).style.left = `${slider.value}%`;
  };
  const choose = (select, image) => {
    const chosen = pictures[select.value];
    Object.assign(image, { src: chosen.src, alt: chosen.alt });
  };
  for (const side of ["left", "right"]) {
    const select = get(`.choose-${side}`, compare), image = get(`.${side}`, stage);
    for (const kind of [...new Set(pictures.map(picture => picture.dataset.kind))]) {
      const group = add(select, "optgroup", undefined, { label: kind });
      pictures.forEach((picture, i) => { if (picture.dataset.kind === kind) add(group, "option", picture.dataset.name, { value: i }); });
    }
    select.value = compare.dataset[side];
    select.addEventListener("change", () => choose(select, image));
    choose(select, image);
    for (const pair of all(".pair", compare))
      pair.addEventListener("click", () => { select.value = pair.dataset[side]; choose(select, image); });
  }
  const follow = event => {
    const box = stage.getBoundingClientRect();
    slider.value = 100 * (event.clientX - box.left) / box.width;
    place();
  };
  let pressed_at = null, dragged = false;
  slider.addEventListener("input", place);
  stage.addEventListener("pointerdown", event => { pressed_at = event.clientX; dragged = false; });
  stage.addEventListener("pointermove", event => {
    dragged ||= event.buttons > 0 && Math.abs(event.clientX - pressed_at) > 3;
    if (event.buttons && dragged) follow(event);
  });
  stage.addEventListener("dragstart", event => event.preventDefault());
  stage.addEventListener("click", event => {
    if (dragged) return;
    const box = stage.getBoundingClientRect(), x = (event.clientX - box.left) / box.width, y = (event.clientY - box.top) / box.height;
    const [left, right] = ["left", "right"].map(side => pictures[get(`.choose-${side}`, compare).value]);
    show_pixel(compare, x, y, ...(100 * x < slider.value ? [left, right] : [right, left]));
  });
  get(".pixel button", compare).addEventListener("click", event => copy_command(event.target));
  for (const [i, picture] of pictures.entries())
    picture.addEventListener("click", () => {
      get(".choose-right", compare).value = i;
      choose(get(".choose-right", compare), get(".right", stage));
      compare.scrollIntoView({ block: "nearest" });
    });
  place();
}

draw_marks();
prepare_curve();
all(".compare").forEach(prepare_compare);
for (const button of all("th button")) button.addEventListener("click", () => sort_by(button.closest("th")));
for (const input of all(".filter input")) input.addEventListener("input", () => filter_rows(input));
for (const row of all("tr[data-run]")) {
  row.addEventListener("click", () => { if (!String(getSelection())) show_run(row.dataset.run); });
  row.addEventListener("keydown", event => { if (event.key === "Enter") show_run(row.dataset.run); });
}
get("#run").addEventListener("click", event => { if (event.target === get("#run")) get("#run").close(); });
dark.addEventListener("change", () => { draw_marks(); if (chart) draw_curve(); });
