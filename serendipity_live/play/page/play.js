"use strict";
(() => {
  const id = (name) => document.getElementById(name);
  const make = (tag, text, kind) => {
    const element = document.createElement(tag);
    if (text !== undefined) element.textContent = text;
    if (kind) element.className = kind;
    return element;
  };
  const t = (text, values = {}) => (texts[text] || text).replace(/\{(\w+)\}/g, (_, name) => values[name]);
  const money = (value) => String(Math.round(value * 1000) / 1000);
  const arrows = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
  const token = location.pathname.startsWith("/s/") ? location.pathname.slice(2) : "";
  const going = 700; // milliseconds that an epoch is shown in which there is nothing to choose
  const settling = 250; // milliseconds in which a click was meant for what stood there before
  let socket = null;
  let view = null; // what the server said last
  let shown = ""; // stage and round of that
  let since = 0; // when that was shown
  let settled = 0;

  const page = () => ({ browser: navigator.userAgent, language: navigator.language, screen: `${screen.width}x${screen.height}`, window: `${innerWidth}x${innerHeight}` });

  // -- talking to the server

  function connect() {
    socket = new WebSocket(`${location.protocol === "https:" ? "wss" : "ws"}://${location.host}/live${token}`);
    socket.addEventListener("open", () => {
      id("lost").hidden = true;
      say({ do: "hello", page: page() });
    });
    socket.addEventListener("message", (event) => hear(JSON.parse(event.data)));
    socket.addEventListener("close", () => {
      id("lost").hidden = false;
      document.body.classList.remove("busy");
      setTimeout(connect, 1000);
    });
  }

  function say(message) {
    if (socket && socket.readyState === WebSocket.OPEN) socket.send(JSON.stringify(message));
  }

  // What is chosen is about the moment that is shown: a click that comes late, or twice, does nothing.
  function answer(message) {
    if (view) say({ moment: view.moment, took: Math.round(performance.now() - since), ...message });
  }

  function hear(message) {
    id("refused").hidden = message.kind !== "refused";
    if (message.kind === "refused") id("refused").textContent = message.error;
    if (message.kind === "explanation") explain(message.sentences);
    if (message.kind === "go") location.assign(message.to);
    if (message.kind === "view") show(message);
  }

  function act(action) {
    if (view && view.stage === "play" && !view.done) answer({ do: "act", action });
  }

  // -- showing what it says

  function show(next) {
    const fresh = shown !== `${next.stage} ${next.round} ${next.study && next.study.again}`;
    const back = view !== null && !next.study && (next.round < view.round || (next.round === view.round && next.epoch < view.epoch));
    if (view === null || view.moment !== next.moment) {
      since = performance.now();
      document.body.classList.add("settling");
      clearTimeout(settled);
      settled = setTimeout(() => document.body.classList.remove("settling"), settling);
    }
    id("anew").hidden = !back;
    view = next;
    shown = `${next.stage} ${next.round} ${next.study && next.study.again}`;
    for (const stage of ["consent", "instructions", "play", "questions", "end", "withdrawn"]) id(stage).hidden = stage !== (next.study && next.study.questions ? "questions" : next.stage);
    id("keys").hidden = next.stage !== "play";
    id("exports").hidden = Boolean(next.study);
    id("scenario").textContent = next.scenario && !next.study ? next.scenario : "";
    if (next.study) theStudy.show(next, fresh);
    if (next.stage === "play") showPlay(fresh);
    if (fresh) scrollTo({ top: 0 });
    // Who is at something goes on with it.
    if (next.stage === "play" && next.busy && !next.done) setTimeout(() => view === next && act(null), going);
  }

  // Whoever uses the keyboard stays where they are, although the choices are new.
  function keepingFocus(change) {
    const focused = document.activeElement;
    const place = focused && focused.closest && focused.closest("#can, #map-scroller");
    const at = place && place.id === "can" ? [...id("can").querySelectorAll("button")].indexOf(focused) : -1;
    change();
    if (!place || view.done) return;
    const offered = [...id("can").querySelectorAll("button")];
    const wanted = at < 0 ? id("map-scroller").querySelector(".reach") : offered[Math.min(at, offered.length - 1)];
    (wanted || offered[0]).focus({ preventScroll: true });
  }

  // What has happened, for those who hear the page.
  function tell(fresh) {
    const last = view.log[0];
    id("told").textContent = fresh || !last ? "" : [t("Epoch {epoch}.", { epoch: view.epoch }), t("You: {action}.", { action: last.you }), ...last.others.map((text) => `${text}.`)].join(" ");
  }

  function showPlay(fresh) {
    keepingFocus(() => showRound(fresh));
    tell(fresh);
  }

  function showRound(fresh) {
    id("goal").replaceChildren(...view.goal.map((part) => {
      const item = make("li", part.text, part.holds ? "holds" : "");
      if (part.holds) item.append(make("span", t(" (done)"), "hidden"));
      return item;
    }));
    id("epoch").textContent = view.done ? view.epoch - 1 : view.epoch;
    id("clock").hidden = view.clock === null;
    id("clock").textContent = view.clock === null ? "" : t("time {time}", { time: view.clock });
    id("going-on").hidden = view.done || !view.going.length;
    id("going").replaceChildren(...view.going.map((text) => make("li", text)));
    theMap.show(view.map, view.can, act, fresh);
    showLegend();
    showFacts();
    showChoices();
    showCosts();
    showThinking();
    showLog();
    id("said").hidden = !view.said;
    id("said-text").textContent = view.said || "";
    id("finish").hidden = !view.done;
    if (view.done) showEnd();
    if (fresh) id("why").hidden = true;
  }

  function showLegend() {
    id("legend").replaceChildren(...view.legend.map((agent) => {
      const item = make("li");
      const sample = make("i", agent.letter, agent.kind);
      sample.style.background = agent.colour;
      sample.style.color = agent.ink;
      item.append(sample, agent.kind === "person" ? t("{name} (you)", { name: agent.name }) : agent.name);
      return item;
    }));
    const entry = (kind, text) => {
      const item = make("li");
      item.append(make("i", "", kind), text);
      id("legend").append(item);
    };
    id("ways").hidden = !view.map || Object.keys(view.map.places).length < 2;
    if (!id("ways").hidden) entry("dashed", t("you can go there"));
    if (view.sight === "here") entry("dim", t("not in sight: as you saw it last"));
  }

  function showFacts() {
    id("facts").hidden = !view.facts;
    if (!view.facts) return;
    const facts = view.facts.length ? view.facts : [t("Nothing is true yet of what can change.")];
    id("facts").replaceChildren(...facts.map((fact) => make("p", fact)));
  }

  function showChoices() {
    id("do").hidden = view.done;
    id("can").replaceChildren(...view.can.map((choice, index) => {
      const item = make("li", undefined, choice.kind);
      const button = make("button");
      button.type = "button";
      const word = make("span", undefined, "word");
      if (choice.kind === "offer") word.append(make("small", t("{robot} is ready:", { robot: choice.with })));
      word.append(choice.text);
      button.append(make("span", choice.kind === "wait" ? "␣" : index < 9 ? index + 1 : "·", "key"), word, make("span", money(choice.cost), "price"));
      button.addEventListener("click", () => act(choice.action));
      item.append(button);
      return item;
    }));
  }

  function bar(name, kind, value, most) {
    const row = make("div", undefined, "bar");
    const track = make("span", undefined, "track");
    const part = make("span", undefined, `part ${kind}`);
    part.style.width = `${Math.min(100, (100 * value) / (most || 1))}%`;
    track.append(part);
    row.append(make("span", name), track, make("output", money(value)));
    return row;
  }

  function showCosts() {
    if (view.study) {
      id("bars").replaceChildren(bar(t("you"), "you", view.paid, Math.max(20, view.paid)));
      return;
    }
    const most = Math.max(view.alone, view.paid, view.team);
    const rows = [bar("you", "you", view.paid, most), bar("you alone", "alone", view.alone, most)];
    const team = view.team !== view.paid && (view.done || view.sight === "everywhere");
    if (team) rows.splice(1, 0, bar("with robots", "team", view.team, most));
    const off = Math.round(view.discount * 100);
    rows.push(make("p", "“You alone” is what the whole way costs without any help." +
      (team ? ` What robots do by themselves counts with ${100 - off} %.` : ""), "note"));
    id("bars").replaceChildren(...rows);
  }

  function showThinking() {
    const thinking = view.thinking;
    id("thinking").hidden = !thinking;
    if (!thinking) return;
    const parts = [];
    const head = make("p");
    const [word, ...rest] = thinking.reason.split(": ");
    head.append(make("span", word, `verdict ${thinking.verdict}`), rest.join(": "));
    parts.push(head);
    for (const goal of thinking.goals) {
      const row = make("div", undefined, "share");
      const track = make("span", undefined, "track");
      const part = make("span", undefined, "part");
      part.style.width = `${100 * goal.share}%`;
      track.append(part);
      row.append(make("span", goal.name), track, make("output", `${Math.round(100 * goal.share)} %`));
      parts.push(row);
    }
    const facts = [];
    if (thinking.expected) facts.push(`It expects you to ${thinking.expected} now.`);
    if (thinking.cost !== null) facts.push(`From here the team pays ${money(thinking.cost)}` + (thinking.alone === null ? "." : `; you alone ${money(thinking.alone)}.`));
    if (thinking.window) facts.push(`It would meet you from epoch ${thinking.window.start} on.`);
    facts.push(`Decided in ${thinking.milliseconds} ms.`);
    parts.push(make("p", facts.join(" "), "faint"));
    if (thinking.plan.length) parts.push(planTable(thinking.plan));
    id("thought").replaceChildren(...parts);
  }

  function planTable(plan) {
    const table = make("table");
    const head = make("tr");
    for (const name of ["epoch", "who", "what"]) head.append(make("th", name));
    table.append(head);
    for (const step of plan) {
      const row = make("tr", undefined, `${step.help ? "help" : ""} ${step.epoch === view.epoch ? "now" : ""}`);
      for (const cell of [step.epoch, step.agents.join(", "), step.text]) row.append(make("td", cell));
      table.append(row);
    }
    const holder = make("div", undefined, "plan");
    holder.append(table);
    return holder;
  }

  function showLog() {
    id("past").hidden = !view.log.length;
    id("log").start = view.log.length;
    id("log").replaceChildren(...view.log.map((entry) => {
      const item = make("li");
      item.append(make("b", entry.you), ...entry.others.map((text) => make("span", text, "robot")));
      return item;
    }));
  }

  // -- the end of a round

  function showEnd() {
    const end = view.end;
    id("again").hidden = id("ask-why").hidden = Boolean(view.study);
    id("go-on").hidden = !view.study;
    id("finish-costs").replaceChildren();
    id("finish-help").replaceChildren();
    if (view.study) theStudy.showRound(view);
    else showOutcome(end);
    id("finish").focus({ preventScroll: false });
  }

  function showOutcome(end) {
    id("finish-title").textContent = end.spared > 0 && end.helped ? "You made it, with a little help" : "You made it";
    id("finish-text").textContent = `${end.epochs} epochs. ` + (end.spared > 0
      ? `You paid ${money(end.paid)} instead of ${money(end.alone)}.`
      : end.spared === 0 ? `You paid ${money(end.paid)}, as much as the best way alone.` : `You paid ${money(end.paid)}; the best way alone costs ${money(end.alone)}.`);
    const rows = [["you", end.paid], ["you and the robots", end.team], ["you alone, at best", end.alone]];
    const table = rows.map(([name, value]) => {
      const row = make("tr");
      row.append(make("th", name), make("td", money(value)));
      return row;
    });
    const total = make("tr", undefined, "total");
    total.append(make("th", end.saved >= 0 ? "saved in all" : "paid more in all"), make("td", money(Math.abs(end.saved))));
    id("finish-costs").append(...table, total);
    id("finish-help").append(make("p", end.help.length ? "What the robots did:" : "The robots did nothing."));
    const list = make("ul");
    for (const step of end.help) list.append(make("li", `epoch ${step.epoch}: ${step.text}`));
    const more = make("details");
    more.append(make("summary", "What they thought, epoch by epoch"));
    const thoughts = make("ol");
    for (const reason of end.reasons) thoughts.append(make("li", reason.text));
    more.append(thoughts);
    id("finish-help").append(list, more);
  }

  function explain(sentences) {
    id("why").hidden = false;
    const head = make("p");
    head.append(make("b", "What the planner says of this task"));
    id("why").replaceChildren(head, ...sentences.map((sentence) => make("p", sentence.text)));
  }

  // -- the rest of the page

  const theStudy = makeStudy({ id, make, money, say, answer, page, t });

  id("again").addEventListener("click", () => say({ do: "again" }));
  id("ask-why").addEventListener("click", () => {
    id("why").hidden = false;
    id("why").replaceChildren(make("p", "Asking the planner …", "faint"));
    say({ do: "explain" });
  });
  id("think").addEventListener("click", () => {
    const open = id("thought").hidden;
    id("thought").hidden = !open;
    id("think").setAttribute("aria-expanded", open);
    say({ do: "panel", open });
  });

  document.addEventListener("keydown", (event) => {
    if (!view || view.stage !== "play" || view.done || event.ctrlKey || event.altKey || event.metaKey) return;
    const direction = arrows[event.key];
    const number = Number(event.key);
    let choice = null;
    if (direction) choice = theMap.towards(...direction, view.can);
    else if (event.key === " " && event.target.tagName !== "BUTTON") choice = view.can.at(-1);
    else if (number >= 1 && number <= 9) choice = view.can[number - 1];
    else return;
    if (direction && event.target.closest && event.target.closest("#can, .plan, #log")) return;
    event.preventDefault();
    if (choice && !event.repeat) act(choice.action);
  });

  // What stands in the page is said in its language, too.
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  while (walker.nextNode()) {
    const text = walker.currentNode.nodeValue;
    if (texts[text.trim()]) walker.currentNode.nodeValue = text.replace(text.trim(), () => texts[text.trim()]);
  }
  connect();
})();
