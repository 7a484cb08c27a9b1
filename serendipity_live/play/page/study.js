"use strict";
// What a study has beside its rounds: consent, instructions, questions, the end.
function makeStudy({ id, make, money, say, answer, page, t }) {
  const visit = String(Math.random()); // so that a double click joins once
  let asked = [];
  let touched = [];
  let begun = 0;

  function show(view, fresh) {
    const { study, stage, round } = view;
    const place = stage !== "play" ? "" : round === 0 ? t(", practice") : t(", round {round} of {rounds}", { round, rounds: study.rounds });
    id("who").hidden = !study.participant;
    id("participant").textContent = (study.participant || "") + place;
    id("withdraw").hidden = stage === "end" || stage === "withdrawn";
    if (!fresh) return;
    if (stage === "consent") {
      paragraphs("consent-text", study.text);
      id("agree").checked = false;
      id("start").disabled = true;
    }
    if (stage === "instructions") {
      paragraphs("instructions-text", study.text);
      id("read-again").hidden = !study.again;
      id("link").textContent = location.href;
    }
    if (study.questions) showQuestions(stage, study.questions);
    if (stage === "end") {
      [id("number").textContent, id("code").textContent] = [study.participant, study.code];
      id("through").hidden = !study.link;
      if (study.link) id("completion-link").href = study.link;
    }
    if (stage === "withdrawn") id("withdrawn-number").textContent = study.participant;
  }

  function paragraphs(where, texts) {
    id(where).replaceChildren(...texts.map((text) => make("p", text)));
  }

  function showRound({ end, round }) {
    id("finish-title").textContent = end.reached ? t("You made it") : t("This round is over");
    const paid = t("{epochs} epochs. You paid {paid}.", { epochs: end.epochs, paid: money(end.paid) });
    const best = end.paid <= end.alone ? t("Nobody could do better.") : t("The best way costs {cost}.", { cost: money(end.alone) });
    id("finish-text").textContent = round === 0 ? `${paid} ${best} ${t("That was for practice; now the rounds begin that count.")}` : paid;
  }

  // -- questions

  function showQuestions(stage, questions) {
    asked = questions;
    touched = questions.map(() => null);
    begun = performance.now();
    const titles = { comprehension: t("What you have read"), questions: t("A few questions about this round"), closing: t("At the end") };
    id("questions-title").textContent = titles[stage];
    id("asked").replaceChildren(...questions.map((question, number) => {
      const field = make("fieldset");
      field.append(make("legend", question.text), ...inputs(question, `q${number}`));
      field.addEventListener("input", () => (touched[number] = Math.round(performance.now() - begun)));
      return field;
    }));
  }

  function inputs(question, name) {
    if (question.kind === "text") {
      const box = make("textarea");
      Object.assign(box, { name, rows: 3, maxLength: 2000, required: question.required });
      box.setAttribute("aria-label", question.text);
      return [box];
    }
    const values = question.kind === "choice" ? question.choices : Array.from({ length: question.points }, (_, i) => i + 1);
    const scale = make("div", undefined, question.kind === "choice" ? "choices" : "scale");
    for (const value of values) {
      const label = make("label", String(value));
      const input = make("input");
      Object.assign(input, { type: "radio", name, value, required: question.required });
      label.prepend(input);
      scale.append(label);
    }
    if (question.kind === "choice") return [scale];
    const ends = make("div", undefined, "ends");
    ends.append(make("span", question.ends[0]), make("span", question.ends[1]));
    return [scale, ends];
  }

  function answers() {
    const form = new FormData(id("form"));
    return asked.map((question, number) => {
      const value = form.get(`q${number}`);
      return question.kind === "scale" && value !== null ? Number(value) : value;
    });
  }

  id("agree").addEventListener("change", () => (id("start").disabled = !id("agree").checked));
  id("start").addEventListener("click", () => {
    const address = Object.fromEntries(new URLSearchParams(location.search));
    say({ do: "join", agree: id("agree").checked, visit, address, page: page() });
  });
  id("understood").addEventListener("click", () => answer({ do: "go on" }));
  id("go-on").addEventListener("click", () => answer({ do: "go on" }));
  id("withdraw").addEventListener("click", () => {
    if (confirm(t("Do you want to withdraw from the study? You can't come back then."))) answer({ do: "withdraw" });
  });
  id("form").addEventListener("submit", (event) => {
    event.preventDefault();
    answer({ do: "answer", answers: answers(), times: touched });
  });

  return { show, showRound };
}
