// The link to the robot: numbered messages there, status back. It reconnects by itself.

const RETRY_MS = 500;
const ENDED_MS = 3000;   // after the end: it may run again
const SILENT_MS = 3000;  // without a status the link counts as lost

export class Link extends EventTarget {
  constructor() {
    super();
    this.n = 0;
    this.you = null;
    this.socket = null;
    this.heard = performance.now();
    this.connect();
    setInterval(() => { if (this.you && performance.now() - this.heard > SILENT_MS) this.lose(); }, 250);
  }

  connect() {
    const address = new URL("link", location.href);
    address.protocol = address.protocol.replace("http", "ws");
    const socket = new WebSocket(address);
    this.socket = socket;
    socket.binaryType = "arraybuffer";  // pictures of the gripper's camera
    socket.onopen = () => { this.n = 0; };
    socket.onmessage = ({ data }) => {
      if (typeof data === "string") this.receive(JSON.parse(data));
      else this.tell("picture", data);
    };
    socket.onclose = () => { if (this.socket === socket) this.lose(); };
  }

  // A socket whose other side is silent may take long to close: it is left to itself.
  lose() {
    const socket = this.socket;
    this.socket = this.you = null;
    socket?.close();
    this.tell("lost");
    setTimeout(() => this.connect(), document.body.dataset.ended ? ENDED_MS : RETRY_MS);
  }

  get open() {
    return this.socket?.readyState === WebSocket.OPEN;
  }

  // Says whether it could be sent at all.
  send(message) {
    if (!this.open) return false;
    this.socket.send(JSON.stringify({ ...message, n: this.n++, t: performance.now() }));
    return true;
  }

  receive(message) {
    this.heard = performance.now();
    if (message.type === "status") this.send({ type: "seen", status: message.number });
    if (message.type === "welcome") this.you = message.you;
    this.tell(message.type, message);
  }

  tell(type, detail) {
    this.dispatchEvent(new CustomEvent(type, { detail }));
  }
}
