// In Meshcat's frame: where its picture is seen from.
(() => {
  "use strict";
  // Put where the console says, or on the gripper; where it comes to rest is told.
  const HAND = ["drake", "visualizer", "lio", "lio_gripper"];
  // On the gripper as Drake's camera there: right, up, back and place in its frame.
  const SEEN = { right: [0, -1, 0], up: [-0.9553, 0, 0.2955], back: [-0.2955, 0, -0.9553], eye: [-0.075, 0, 0.085] };
  const WIDE = 70, NORMAL = 40;  // [deg]
  const rotated = ([x, y, z]) => [x, z, -y];  // Meshcat's own axes have y up
  // What is wanted holds at each picture until somebody takes hold of it: Meshcat puts the camera, too, and anew.
  let told = "", following = false, wanted = null, held = null;

  // Called by the console's page. It is no message: a part of Meshcat's script sends each one on to itself, for ever.
  window.lookFrom = (data) => {
    if (!window.viewer?.controls) return;
    following = Boolean(data.follow);
    wanted = data.eye ? { eye: rotated(data.eye), target: rotated(data.target) } : null;
    viewer.controls.enabled = !following;
    viewer.camera.fov = following ? WIDE : NORMAL;
    viewer.render_callback = () => { following ? follow() : put(); };
    viewer.set_dirty();
  };

  function put() {
    const { camera, controls } = viewer;
    if (held !== controls) {
      held = controls;
      controls.addEventListener("start", () => { wanted = null; });
    }
    if (!wanted) return;
    camera.position.set(...wanted.eye);
    controls.target.set(...wanted.target);
    controls.update();
    camera.updateMatrixWorld(true);
  }

  function follow() {
    const { Matrix4, Vector3 } = MeshCat.THREE;
    const hand = viewer.scene_tree.find(HAND).object, camera = viewer.camera;
    hand.updateWorldMatrix(true, false);
    camera.parent.updateWorldMatrix(true, false);
    const mount = new Matrix4().makeBasis(...[SEEN.right, SEEN.up, SEEN.back].map((v) => new Vector3(...v)));
    mount.setPosition(...SEEN.eye);
    mount.premultiply(hand.matrixWorld).premultiply(camera.parent.matrixWorld.clone().invert());
    mount.decompose(camera.position, camera.quaternion, new Vector3());
    camera.updateMatrixWorld(true);
  }

  setInterval(() => {
    if (!window.viewer?.camera || following) return;
    const m = viewer.camera.matrixWorld.elements;
    const plain = (x, y, z) => [x, -z, y].map((v) => Math.round(v * 1000) / 1000);
    const now = { right: plain(m[0], m[1], m[2]), up: plain(m[4], m[5], m[6]) };
    const text = JSON.stringify(now);
    if (text === told) return;
    told = text;
    window.parent.postMessage(now, location.origin);
  }, 300);
  window.addEventListener("load", () => {
    const wait = setInterval(() => {
      if (!window.viewer?.controls) return;
      clearInterval(wait);
      window.parent.postMessage({ ready: true }, location.origin);
    }, 50);
  });
})();
