"""What is drawn: the canal and the trail, cameras and films, the Meshcat page and its recording."""

from diagrams.view.cameras import X_GRIPPER_CAMERA, VideoRecorder, film_kind
from diagrams.view.canal_meshes import TriangleMesh, canal_rings, canal_skin, dashes, merge, tube
from diagrams.view.canal_view import CanalView
from diagrams.view.meshcat_notice import MeshcatNotice
from diagrams.view.meshcat_page import leave, start_meshcat
from diagrams.view.meshcat_recording import Recording

__all__ = [
    "X_GRIPPER_CAMERA",
    "CanalView",
    "MeshcatNotice",
    "Recording",
    "TriangleMesh",
    "VideoRecorder",
    "canal_rings",
    "canal_skin",
    "dashes",
    "film_kind",
    "leave",
    "merge",
    "start_meshcat",
    "tube",
]
