"use strict";
// The map: drawn by the server, moved and made clickable here.
const theMap = (() => {
  const space = "http://www.w3.org/2000/svg";
  const scroller = document.getElementById("map-scroller");
  let drawn = null; // the map that is shown

  function box(map, place, kind, inset) {
    const [x, y, width, height] = map.places[place];
    const rect = document.createElementNS(space, "rect");
    const where = { x: x - width / 2 + inset, y: y - height / 2 + inset, width: width - 2 * inset, height: height - 2 * inset, rx: 10 };
    for (const [name, value] of Object.entries(where)) rect.setAttribute(name, value);
    rect.setAttribute("class", kind);
    return rect;
  }

  function reachable(map, choice, act) {
    const rect = box(map, choice.place, "reach", 5);
    rect.setAttribute("tabindex", "0");
    rect.setAttribute("role", "button");
    rect.setAttribute("aria-label", choice.text);
    rect.dataset.place = choice.place;
    rect.addEventListener("click", () => act(choice.action));
    rect.addEventListener("keydown", (event) => {
      if (event.key !== "Enter" && event.key !== " ") return;
      event.preventDefault();
      event.stopPropagation(); // elsewhere on the page a blank waits
      if (!event.repeat) act(choice.action);
    });
    return rect;
  }

  function spots() {
    const found = {};
    for (const token of scroller.querySelectorAll("[data-token]")) found[token.dataset.token] = token.getAttribute("transform");
    return found;
  }

  function css(transform) {
    const numbers = /translate\(([-\d.]+)[ ,]([-\d.]+)\)/.exec(transform || "");
    return numbers ? `translate(${numbers[1]}px, ${numbers[2]}px)` : "none";
  }

  function glide(before) {
    for (const token of scroller.querySelectorAll("[data-token]")) {
      const to = css(token.getAttribute("transform"));
      const from = css(before[token.dataset.token]);
      if (from === "none" || from === to) continue;
      token.style.transition = "none";
      token.style.transform = from;
      token.getBoundingClientRect(); // so that it starts there
      token.style.transition = "";
      token.style.transform = to;
    }
  }

  function keepInSight(map) {
    if (!map.here) return;
    const scale = scroller.firstElementChild.getBoundingClientRect().width / map.width;
    const [x, y] = map.places[map.here];
    scroller.scrollTo({ left: x * scale - scroller.clientWidth / 2, top: y * scale - scroller.clientHeight / 2, behavior: "smooth" });
  }

  function show(map, choices, act, fresh) {
    drawn = map;
    if (!map) {
      scroller.replaceChildren();
      return;
    }
    const before = fresh ? {} : spots();
    scroller.innerHTML = map.svg;
    const svg = scroller.firstElementChild;
    const small = map.width <= 1200;
    svg.style.setProperty("--least", `${Math.round(map.width * (small ? 0.6 : 0.65))}px`);
    svg.style.setProperty("--most", `${Math.round(map.width * 1.35)}px`);
    svg.removeAttribute("width");
    svg.removeAttribute("height");
    svg.setAttribute("role", "group");
    const ground = svg.querySelector("[data-token]");
    const below = (rect) => (ground ? ground.before(rect) : svg.append(rect));
    const layer = ground ? ground.parentNode : svg;
    // Boxes have the picture's margin in them already; tokens stand inside a group that is moved by it.
    const shift = layer === svg ? "" : layer.getAttribute("transform") || "";
    const numbers = /translate\(([-\d.]+)[ ,]([-\d.]+)\)/.exec(shift);
    const moved = document.createElementNS(space, "g");
    if (numbers) moved.setAttribute("transform", `translate(${-numbers[1]} ${-numbers[2]})`);
    below(moved);
    if (map.seen) for (const place of Object.keys(map.places)) if (!map.seen.includes(place)) moved.append(box(map, place, "unseen", 2));
    if (map.here) {
      const here = box(map, map.here, "here", 4);
      here.dataset.place = map.here;
      moved.append(here);
    }
    for (const key of map.remembered) {
      const token = svg.querySelector(`[data-token="${key}"]`);
      if (token) token.classList.add("remembered");
    }
    const top = document.createElementNS(space, "g");
    for (const choice of choices) if (choice.place && map.places[choice.place]) top.append(reachable(map, choice, act));
    svg.append(top);
    glide(before);
    keepInSight(map);
    tellSize();
  }

  function tellSize() {
    const goesOn = scroller.scrollWidth > scroller.clientWidth + 4 || scroller.scrollHeight > scroller.clientHeight + 4;
    document.getElementById("map-size").hidden = !drawn || !(goesOn || scroller.classList.contains("whole"));
  }

  document.getElementById("map-whole").addEventListener("click", (event) => {
    const whole = scroller.classList.toggle("whole");
    event.currentTarget.setAttribute("aria-pressed", whole);
    if (!whole) keepInSight(drawn);
  });
  addEventListener("resize", tellSize);

  // The reachable place that lies in a direction, if one does.
  function towards(dx, dy, choices) {
    if (!drawn || !drawn.here) return null;
    const [x, y, width, height] = drawn.places[drawn.here];
    let best = null;
    let least = Infinity;
    for (const choice of choices) {
      if (!choice.place || !drawn.places[choice.place]) continue;
      const [px, py, pw, ph] = drawn.places[choice.place];
      const gap = (d, a, b) => Math.sign(d) * Math.max(0, Math.abs(d) - (a + b) / 2 + 1);
      const gx = gap(px - x, width, pw);
      const gy = gap(py - y, height, ph);
      const along = gx * dx + gy * dy;
      const aside = Math.abs(gx * dy) + Math.abs(gy * dx);
      if (along <= 0 || aside > along) continue;
      const distance = Math.hypot(px - x, py - y) + 2 * (Math.abs((px - x) * dy) + Math.abs((py - y) * dx));
      if (distance < least) [best, least] = [choice, distance];
    }
    return best;
  }

  return { show, towards };
})();
