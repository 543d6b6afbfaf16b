// The WebSocket beside the page. It reconnects by itself, waiting longer after each failure, up to eight seconds.

{
  const firstWait = 300, longestWait = 8000;  // milliseconds

  /// Emits: open, closed ({ wait: milliseconds until the next attempt }), text (a message), binary (an ArrayBuffer).
  alhazen.Connection = class extends alhazen.Events {
    #url;
    #socket = null;
    #wait = firstWait;
    #timer = 0;
    /// Messages of each type that were sent, for the tests: what happens in the page alone must send none.
    sent = {};

    constructor(pageUrl) {
      super();
      const url = new URL("socket", pageUrl);
      url.protocol = url.protocol === "https:" ? "wss:" : "ws:";
      this.#url = url.href;
      // Browsers keep a socket open while they wait for a page that may come back.
      addEventListener("pagehide", () => this.#socket?.close());
      addEventListener("pageshow", (event) => event.persisted && this.connect());
    }

    get isOpen() {
      return this.#socket?.readyState === WebSocket.OPEN;
    }

    connect() {
      clearTimeout(this.#timer);
      const socket = new WebSocket(this.#url);
      socket.binaryType = "arraybuffer";
      this.#socket = socket;
      socket.onopen = () => {
        this.#wait = firstWait;
        this.emit("open");
      };
      socket.onmessage = (event) => {
        if (typeof event.data === "string") this.#receiveText(event.data);
        else this.emit("binary", event.data);
      };
      socket.onclose = () => {
        if (this.#socket !== socket) return;
        this.emit("closed", { wait: this.#wait });
        this.#timer = setTimeout(() => this.connect(), this.#wait);
        this.#wait = Math.min(2 * this.#wait, longestWait);
      };
    }

    send(message) {
      if (!this.isOpen) return false;
      this.sent[message.type] = (this.sent[message.type] ?? 0) + 1;
      this.#socket.send(JSON.stringify(message));
      return true;
    }

    #receiveText(text) {
      let message;
      try {
        message = JSON.parse(text);
      } catch {
        console.warn("a message that is not JSON:", text);
        return;
      }
      this.emit("text", message);
    }
  };
}
