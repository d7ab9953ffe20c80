// Alarms, the worst first, each with its acknowledgement.
import {el, put, reconcile} from "./dom.js";
import {mayOrder, onSession, order} from "./orders.js";

const kMarks = {critical: "✖ critical", warning: "▲ warning", notice: "● notice"};
const kLooks = {critical: "bad-text", warning: "caution-text", notice: "soft"};

export function makeAlarms() {
  const all = el(
    "button",
    {type: "button", onclick: () => order({kind: "acknowledge_alarm", target: "*"}), hidden: true},
    "Acknowledge all",
  );
  const list = el("div", {class: "scroll", "data-field": "alarms", tabindex: 0, role: "group", "aria-label": "Alarms"});
  const root = el(
    "section",
    {class: "card lines alarms", "aria-label": "Alarms"},
    el("div", {class: "line"}, el("div", {class: "title"}, el("h2", {}, "Alarms"), all), list),
  );
  const allow = () => {
    all.disabled = !mayOrder();
    all.title = mayOrder() ? "" : "Needs the role operator";
  };
  onSession(allow);
  allow();
  /** Silence of the monitor, which raises them, is no good sign. */
  function showNone(monitored) {
    const key = monitored ? "none" : "unheard";
    if (list.firstChild?.dataset?.key === key) return;
    const words = monitored ? "✔ No alarm" : "○ The monitor is not heard, and nobody else raises alarms";
    list.replaceChildren(el("p", {class: monitored ? "good-text" : "caution-text", "data-key": key}, words));
  }
  return {
    root,
    update({status: {alarms, gps}}) {
      all.hidden = alarms.filter((alarm) => !alarm.acknowledged).length < 2;
      if (alarms.length > 0) reconcile(list, alarms, (alarm) => alarm.alarm, makeAlarm, updateAlarm);
      else showNone(gps !== null);
    },
  };
}

function makeAlarm(alarm) {
  return el(
    "div",
    {class: "alarm", "data-alarm": alarm.alarm},
    el("span", {class: "severity"}),
    el("p"),
    el("p", {class: "kind num"}),
    el(
      "button",
      {
        type: "button",
        "aria-label": "Acknowledge " + alarm.alarm,
        onclick: () => order({kind: "acknowledge_alarm", target: alarm.alarm}),
      },
      "Acknowledge",
    ),
  );
}

function updateAlarm(node, alarm) {
  const [severity, text, more, button] = node.children;
  put(severity, alarm.active ? kMarks[alarm.severity] : "○ over");
  severity.className = "severity " + (alarm.active ? kLooks[alarm.severity] : "soft");
  put(text, alarm.text);
  put(more, `since ${alarm.since_utc?.slice(11, 19) ?? "–"}` + (alarm.acknowledged ? " · seen" : ""));
  more.title = alarm.alarm;
  button.hidden = alarm.acknowledged;
  button.disabled = !mayOrder();
}
