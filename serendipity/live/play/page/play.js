"use strict";
(() => {
  const id = (name) => document.getElementById(name);
  const make = (tag, text, kind) => {
    const element = document.createElement(tag);
    if (text !== undefined) element.textContent = text;
    if (kind) element.className = kind;
    return element;
  };
  const money = (value) => String(Math.round(value * 1000) / 1000);
  const arrows = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
  let socket = null;
  let view = null; // what the server said last
  let shown = ""; // stage and round of that

  // -- talking to the server

  function connect() {
    socket = new WebSocket(`ws://${location.host}/live`);
    socket.addEventListener("open", () => (id("lost").hidden = true));
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

  function hear(message) {
    id("refused").hidden = message.kind !== "refused";
    if (message.kind === "refused") id("refused").textContent = message.error;
    if (message.kind === "explanation") explain(message.sentences);
    if (message.kind === "view") show(message);
  }

  function act(action) {
    if (view && view.stage === "play" && !view.done) say({ do: "act", round: view.round, epoch: view.epoch, action });
  }

  // -- showing what it says

  function show(next) {
    const fresh = shown !== `${next.stage} ${next.round}`;
    view = next;
    shown = `${next.stage} ${next.round}`;
    for (const stage of ["consent", "play", "questions", "end"]) id(stage).hidden = stage !== next.stage;
    id("keys").hidden = next.stage !== "play";
    const study = next.study;
    id("exports").hidden = Boolean(study) && next.stage !== "end";
    id("participant").hidden = !study;
    if (study) id("participant").textContent = study.participant + (next.stage === "play" ? `, round ${next.round} of ${study.rounds}` : "");
    id("scenario").textContent = next.scenario && !study ? next.scenario : "";
    if (next.stage === "play") showPlay(fresh);
    if (next.stage === "consent" && fresh) showConsent();
    if (next.stage === "questions" && fresh) showQuestions();
    if (next.stage === "end") id("number").textContent = study.participant;
    if (fresh) scrollTo({ top: 0 });
  }

  function showPlay(fresh) {
    id("goal").replaceChildren(...view.goal.map((part) => {
      const item = make("li", part.text, part.holds ? "holds" : "");
      if (part.holds) item.append(make("span", " (done)", "hidden"));
      return item;
    }));
    id("epoch").textContent = view.done ? view.epoch - 1 : view.epoch;
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
      item.append(sample, agent.kind === "person" ? `${agent.name} (you)` : agent.name);
      return item;
    }));
    const entry = (kind, text) => {
      const item = make("li");
      item.append(make("i", "", kind), text);
      id("legend").append(item);
    };
    if (view.map) entry("dashed", "you can go there");
    if (view.sight === "here") entry("dim", "not in sight: as you saw it last");
  }

  function showFacts() {
    id("facts").hidden = !view.facts;
    if (!view.facts) return;
    const facts = view.facts.length ? view.facts : ["Nothing is true yet of what can change."];
    id("facts").replaceChildren(...facts.map((fact) => make("p", fact)));
  }

  function showChoices() {
    id("do").hidden = view.done;
    id("can").replaceChildren(...view.can.map((choice, index) => {
      const item = make("li", undefined, choice.kind);
      const button = make("button");
      button.type = "button";
      const word = make("span", undefined, "word");
      if (choice.kind === "offer") word.append(make("small", `${choice.with} is ready:`));
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
    const most = Math.max(view.alone, view.paid, view.team);
    const rows = [bar("you", "you", view.paid, most), bar("you alone", "alone", view.alone, most)];
    const team = view.condition !== null && view.team !== view.paid && (view.done || view.sight === "everywhere");
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
    id("finish-title").textContent = end.spared > 0 && end.helped ? "You made it, with a little help" : "You made it";
    id("finish-text").textContent = `${end.epochs} epochs. ` + (end.spared > 0
      ? `You paid ${money(end.paid)} instead of ${money(end.alone)}.`
      : end.spared === 0 ? `You paid ${money(end.paid)}, as much as the best way alone.` : `You paid ${money(end.paid)}; the best way alone costs ${money(end.alone)}.`);
    const rows = [["you", end.paid], ["you and the robots", end.team], ["you alone, at best", end.alone]];
    const table = rows.slice(0, view.study ? 1 : 3).map(([name, value]) => {
      const row = make("tr");
      row.append(make("th", name), make("td", money(value)));
      return row;
    });
    if (!view.study) {
      const total = make("tr", undefined, "total");
      total.append(make("th", end.saved >= 0 ? "saved in all" : "paid more in all"), make("td", money(Math.abs(end.saved))));
      table.push(total);
    }
    id("finish-costs").replaceChildren(...table);
    id("finish-help").replaceChildren();
    if (!view.study) {
      id("finish-help").append(make("p", end.help.length ? "What the robots did:" : "The robots did nothing."));
      const list = make("ul");
      for (const step of end.help) list.append(make("li", `epoch ${step.epoch}: ${step.text}`));
      id("finish-help").append(list);
      const more = make("details");
      more.append(make("summary", "What they thought, epoch by epoch"));
      const thoughts = make("ol");
      for (const reason of end.reasons) thoughts.append(make("li", reason.text));
      more.append(thoughts);
      id("finish-help").append(more);
    }
    id("again").hidden = id("ask-why").hidden = Boolean(view.study);
    id("go-on").hidden = !view.study;
    id("finish").focus({ preventScroll: false });
  }

  function explain(sentences) {
    id("why").hidden = false;
    const head = make("p");
    head.append(make("b", "What the planner says of this task"));
    id("why").replaceChildren(head, ...sentences.map((sentence) => make("p", sentence.text)));
  }

  // -- a study

  function showConsent() {
    id("consent-text").replaceChildren(...view.study.consent.map((text) => make("p", text)));
    id("agree").checked = false;
    id("start").disabled = true;
  }

  function showQuestions() {
    id("asked").replaceChildren(...view.study.questions.map((question, number) => {
      const field = make("fieldset");
      const scale = make("div", undefined, "scale");
      for (let value = 1; value <= 7; value += 1) {
        const label = make("label", String(value));
        const input = make("input");
        Object.assign(input, { type: "radio", name: `q${number}`, value, required: true });
        label.prepend(input);
        scale.append(label);
      }
      field.append(make("legend", question), scale);
      return field;
    }));
    id("comment").value = "";
  }

  id("agree").addEventListener("change", () => (id("start").disabled = !id("agree").checked));
  id("start").addEventListener("click", () => say({ do: "go on", agree: id("agree").checked }));
  id("go-on").addEventListener("click", () => say({ do: "go on" }));
  id("next").addEventListener("click", () => say({ do: "go on" }));
  id("form").addEventListener("submit", (event) => {
    event.preventDefault();
    const answers = view.study.questions.map((_, number) => Number(new FormData(id("form")).get(`q${number}`)));
    say({ do: "go on", round: view.round, answers, comment: id("comment").value });
  });

  // -- the rest of the page

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

  connect();
})();
