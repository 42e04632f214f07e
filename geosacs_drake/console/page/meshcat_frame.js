// Runs before Meshcat's own script, in its frame: takes pictures apart that come as one message, says which was drawn,
// and lets nothing else go back. Meshcat's script is Drake's, unchanged.
(() => {
  "use strict";
  window.parent.listenToKeys?.(window);
  const Native = window.WebSocket;

  class OneWay {
    constructor() {
      const address = new URL("socket", location.href);
      address.protocol = address.protocol.replace("http", "ws");
      this.socket = new Native(address);
      this.socket.binaryType = "arraybuffer";
      this.socket.onopen = (event) => this.onopen?.(event);
      this.socket.onclose = (event) => this.onclose?.(event);
      this.socket.onmessage = ({ data }) => this.receive(data);
    }
    get readyState() { return this.socket.readyState; }
    send() {}
    close() { this.socket.close(); }
    receive(data) {
      const view = new DataView(data);
      const number = view.getUint32(0, true);
      for (let at = 4; at < data.byteLength; ) {
        const size = view.getUint32(at, true);
        this.onmessage?.({ data: data.slice(at + 4, at + 4 + size) });
        at += 4 + size;
      }
      quality.prepare();
      const came = performance.now();
      // Meshcat draws in the next frame; the one after it begins when that is done.
      requestAnimationFrame(() => requestAnimationFrame(() => {
        quality.took(performance.now() - came);
        if (this.socket.readyState === Native.OPEN) this.socket.send(String(number));
        window.parent.postMessage({ drawn: number }, location.origin);
      }));
    }
  }

  for (const name of ["CONNECTING", "OPEN", "CLOSING", "CLOSED"]) OneWay[name] = Native[name];
  window.WebSocket = OneWay;

  // What Meshcat lays over its picture is not for an operator.
  const style = document.createElement("style");
  style.textContent = "#stats-plot, #status-message, .lil-gui, .dg { display: none !important; } canvas { outline: none; }";
  document.documentElement.append(style);
  // A gamepad is read by our own page.
  try { Object.defineProperty(navigator, "getGamepads", { value: () => [] }); } catch { /* then it goes nowhere */ }
})();
