"use strict";
(() => {
  const id = (name) => document.getElementById(name);
  const all = (selector) => [...document.querySelectorAll(selector)];
  const calm = matchMedia("(prefers-reduced-motion: reduce)");
  const pace = 1100; // milliseconds an epoch is shown while playing
  const others = {}; // what scenarios that are not shown consist of, once they have been
  let scene = null; // what is shown, and its last epoch
  let last = 0;
  let epoch = 0;
  let timer = null;

  const move = (element, x, y) => element.setAttribute("transform", `translate(${x} ${y})`);

  // A frame about several: as large as it has to be, and with their names.
  function drawSheet(token, outline, [, , , width, height, names]) {
    const sheet = { x: -width / 2, y: -height / 2, width, height };
    for (const [name, value] of Object.entries(sheet)) outline.setAttribute(name, value);
    token.querySelector("title").textContent = names;
  }

  function drawTokens(frame) {
    for (const token of all("[data-token]")) {
      const spot = frame.tokens[token.dataset.token];
      token.style.display = spot ? "" : "none";
      if (!spot) continue;
      // CSS transforms can be animated, the attribute can't: it is for readers without styles.
      move(token, spot[0], spot[1]);
      token.style.transform = `translate(${spot[0]}px, ${spot[1]}px)`;
      const outline = token.querySelector("rect");
      if (spot.length > 3) drawSheet(token, outline, spot);
      if (token.dataset.token.startsWith("frame-")) {
        outline.setAttribute("stroke", spot[2] === null ? "#1f2328" : scene.colours[spot[2]]);
      }
      if (token.dataset.token.startsWith("object-")) {
        outline.setAttribute("stroke", spot[2] === null ? "#1f2328" : scene.colours[spot[2]]);
        outline.setAttribute("stroke-width", spot[2] === null ? 2 : 3);
      }
    }
    for (const line of all("[data-trail]")) {
      const done = scene.trails[line.dataset.trail].slice(0, epoch + 1).filter(Boolean);
      line.setAttribute("d", done.length ? `M${done.join("L")}` : "");
    }
  }

  function drawCosts(frame) {
    const share = (value) => `${(100 * value) / scene.most}%`;
    all("#bar-team .part").forEach((part, i) => { part.style.width = share(frame.spent[i]); });
    id("cost").textContent = frame.cost;
    if (id("former-cost")) {
      document.querySelector("#bar-former .part").style.width = share(frame.formerValue);
      id("former-cost").textContent = frame.former;
    }
  }

  function drawWords(frame) {
    const clock = frame.clock && ` (time ${frame.clock})`;
    const name = epoch === 0 ? "Start" : `Epoch ${epoch} of ${last}${clock}`;
    id("epoch").textContent = name;
    const met = scene.meetings.filter((meeting) => meeting.epoch === epoch).map((meeting) => meeting.text);
    const flag = id("flag");
    flag.hidden = !(frame.window || met.length);
    flag.textContent = met.join("; ") || "window";
    flag.classList.toggle("met", met.length > 0);
    id("caption").textContent = frame.caption;
    const facts = [];
    if (frame.made.length) facts.push(`Now true: ${frame.made.join(", ")}.`);
    if (frame.undone.length) facts.push(`No longer true: ${frame.undone.join(", ")}.`);
    id("facts").textContent = facts.join(" ");
    id("slider").value = epoch;
    id("slider").setAttribute("aria-valuetext", `${name}. ${met.join("; ")} ${frame.caption}`);
  }

  const calmly = () => (calm.matches ? "auto" : "smooth");

  function followLanes() {
    const scroller = id("lane-scroller");
    scroller.scrollTo({ left: (epoch + 0.5) * scene.column - scroller.clientWidth / 2, behavior: calmly() });
  }

  function followTokens(frame) {
    const map = id("map");
    const scroller = id("map-scroller");
    const agents = Object.keys(frame.tokens).filter((key) => key.startsWith("agent-"));
    if (!map || !agents.length) return;
    const scrolls = scroller.scrollWidth > scroller.clientWidth || scroller.scrollHeight > scroller.clientHeight;
    if (scrolls) scroller.tabIndex = 0;
    else scroller.removeAttribute("tabindex");
    const scale = map.getBoundingClientRect().width / map.viewBox.baseVal.width;
    // All agents, where they fit; else the human, or whoever there is.
    const centre = (axis, room) => {
      const at = agents.map((key) => (frame.tokens[key][axis] + scene.margin) * scale);
      const [least, most] = [Math.min(...at), Math.max(...at)];
      const one = at[Math.max(0, agents.indexOf(scene.human))];
      return (most - least < room * 0.8 ? (least + most) / 2 : one) - room / 2;
    };
    const left = centre(0, scroller.clientWidth);
    scroller.scrollTo({ left, top: centre(1, scroller.clientHeight), behavior: calmly() });
  }

  function show(wanted) {
    epoch = Math.min(last, Math.max(0, wanted));
    const frame = scene.frames[epoch];
    drawTokens(frame);
    drawCosts(frame);
    drawWords(frame);
    const cursor = document.querySelector("[data-cursor]");
    cursor.style.transform = `translate(${epoch * scene.column}px, 0)`;
    for (const each of all("[data-meeting]")) {
      const met = each.dataset.meeting.split(" ").some((index) => scene.meetings[index].epoch === epoch);
      each.classList.toggle("now", met);
    }
    id("map-scroller").classList.toggle("in-window", frame.window);
    all("tbody tr").forEach((row, i) => row.classList.toggle("now", i + 1 === epoch));
    for (const name of ["first", "back"]) id(name).disabled = epoch === 0;
    for (const name of ["forward", "end"]) id(name).disabled = epoch === last;
    followLanes();
    followTokens(frame);
    if (epoch === last) pause();
  }

  function pause() {
    clearInterval(timer);
    timer = null;
    showPlaying();
  }

  function play() {
    if (last === 0) return;
    if (epoch === last) show(0);
    timer = setInterval(() => show(epoch + 1), pace);
    showPlaying();
  }

  function showPlaying() {
    const playing = timer !== null;
    id("play").setAttribute("aria-pressed", playing);
    id("play").setAttribute("aria-label", playing ? "Pause" : "Play");
    id("play-word").textContent = playing ? "Pause" : "Play";
    // While it plays, a reader of every caption would lag behind.
    document.querySelector(".now").setAttribute("aria-live", playing ? "off" : "polite");
  }

  const step = (wanted) => { pause(); show(wanted); };
  const keys = {
    ArrowLeft: () => step(epoch - 1),
    ArrowRight: () => step(epoch + 1),
    Home: () => step(0),
    End: () => step(last),
    " ": () => (timer === null ? play() : pause()),
  };

  function listen() {
    id("play").addEventListener("click", keys[" "]);
    id("first").addEventListener("click", keys.Home);
    id("back").addEventListener("click", keys.ArrowLeft);
    id("forward").addEventListener("click", keys.ArrowRight);
    id("end").addEventListener("click", keys.End);
    id("slider").addEventListener("input", (event) => step(Number(event.target.value)));
    id("lanes").addEventListener("click", (event) => {
      const column = event.target.closest("[data-column], [data-act]");
      if (column) step(Number(column.dataset.column ?? column.dataset.act));
    });
  }

  function begin() {
    scene = JSON.parse(id("data").textContent);
    last = scene.frames.length - 1;
    id("play").disabled = last === 0;
    showPlaying();
    show(epoch);
  }

  // Another scenario takes the place of the one that is shown, in the same epoch.
  function choose(shown, wanted) {
    pause();
    const main = document.querySelector("main");
    const template = document.querySelector(`template[data-scenario="${wanted}"]`);
    others[shown] = [...main.childNodes];
    main.replaceChildren(...(others[wanted] ?? template.content.childNodes));
    if (!others[wanted]) listen();
    all("header p").slice(1, -1).forEach((line, i) => line.classList.toggle("played", i === wanted));
    begin();
  }

  document.addEventListener("keydown", (event) => {
    if (event.altKey || event.ctrlKey || event.metaKey || !(event.key in keys)) return;
    const where = event.target.closest("button, summary, input, select");
    // What has the focus keeps the keys that it answers to itself.
    if (where && (event.key === " " ? where.id !== "slider" : ["slider", "scenario"].includes(where.id))) return;
    event.preventDefault();
    keys[event.key]();
  });
  addEventListener("beforeprint", () => all("details").forEach((each) => { each.open = true; }));
  addEventListener("resize", () => followTokens(scene.frames[epoch]));
  const choice = id("scenario");
  let shown = choice && Number(choice.value);
  choice?.addEventListener("change", () => {
    const wanted = Number(choice.value);
    choose(shown, wanted);
    shown = wanted;
  });
  listen();
  begin();
})();
