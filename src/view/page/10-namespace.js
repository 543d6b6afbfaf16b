"use strict";

// The page of `alhazen view`: everything hangs on this one object. Files are read in the order of their names, so each
// uses only what files with lower numbers define, except inside functions that run once the page has been built.

const alhazen = {};

{
  /// Creates an element. Keys of `attributes` that name a property of the element (className, textContent, onclick) set
  /// it; all others are attributes. Inline handlers and styles in HTML would violate the policy of the page.
  alhazen.element = (tag, attributes = {}, ...children) => {
    const element = document.createElement(tag);
    for (const [key, value] of Object.entries(attributes)) {
      if (value === undefined || value === null) continue;
      if (key in element && !key.startsWith("aria")) element[key] = value;
      else element.setAttribute(key, value);
    }
    element.append(...children.filter((child) => child !== null && child !== undefined));
    return element;
  };

  alhazen.byId = (id) => document.getElementById(id);

  /// Listeners of named events, each called with what is emitted.
  alhazen.Events = class {
    #listeners = new Map();

    on(name, listener) {
      if (!this.#listeners.has(name)) this.#listeners.set(name, []);
      this.#listeners.get(name).push(listener);
    }

    emit(name, value) {
      for (const listener of this.#listeners.get(name) ?? []) listener(value);
    }
  };

  /// Calls `action` once in the next animation frame, however often the returned function is called before.
  alhazen.oncePerFrame = (action) => {
    let pending = false;
    return () => {
      if (pending) return;
      pending = true;
      requestAnimationFrame(() => {
        pending = false;
        action();
      });
    };
  };

  /// Calls `action` at most once in `milliseconds`, the last time after the last call.
  alhazen.throttled = (action, milliseconds) => {
    let timer = 0;
    return () => {
      timer ||= setTimeout(() => {
        timer = 0;
        action();
      }, milliseconds);
    };
  };

  alhazen.clamp = (value, low, high) => Math.min(Math.max(value, low), high);

  alhazen.prefersReducedMotion = () => matchMedia("(prefers-reduced-motion: reduce)").matches;

  /// A number with at most `digits` significant digits, without trailing zeros.
  alhazen.shortNumber = (value, digits = 5) => {
    if (!Number.isFinite(value)) return String(value);
    return String(Number(value.toPrecision(digits)));
  };

  /// Seconds as people read them: 4.2 s, 3 min 05 s, 2 h 10 min.
  alhazen.duration = (seconds) => {
    if (!(seconds >= 0)) return "–";
    if (seconds < 59.95) return `${seconds.toFixed(1)} s`;
    const whole = Math.round(seconds);
    const pad = (value) => String(value).padStart(2, "0");
    if (whole < 3600) return `${Math.floor(whole / 60)} min ${pad(whole % 60)} s`;
    return `${Math.floor(whole / 3600)} h ${pad(Math.floor((whole % 3600) / 60))} min`;
  };

  /// Copies text and says so. Clipboards need a secure context, which http://127.0.0.1 is and other addresses are not.
  alhazen.copyText = async (text, what) => {
    try {
      await navigator.clipboard.writeText(text);
    } catch {
      const area = alhazen.element("textarea", { value: text, className: "offscreen", "aria-hidden": "true" });
      document.body.append(area);
      area.select();
      document.execCommand("copy");
      area.remove();
    }
    alhazen.lastCopied = text;
    alhazen.notices.say(`Copied ${what}`);
  };
}
