"""The recorder as a system: it keeps the path of the tool, and leads back along it."""

from __future__ import annotations

import numpy as np
from pydrake.common.value import Value
from pydrake.systems.framework import BasicVector, Context, DiagramBuilder, LeafSystem, OutputPort, State

from canal.navigation.joystick import JOYSTICK_PERIOD
from diagrams.teach.jog import JOG_SIZE
from diagrams.teach.path import TaughtPath, Word


class DemonstrationRecorder(LeafSystem):
    """Records where the tool is, 20 times a second.

    ```
    X_BT (7) → ┌───────────────────────┐
     jog (7) → │ DemonstrationRecorder │ → way_back (8)
    word (1) → └───────────────────────┘
    ```

    `word` is a `Word`, for one sample each. `way_back` is 1 while the tool is to be led back along its path (else 0),
    and the pose that it is led to. The state is a `TaughtPath`.
    """

    def __init__(self) -> None:
        super().__init__()
        self._X_BT = self.DeclareVectorInputPort("X_BT", 7)
        self._jog = self.DeclareVectorInputPort("jog", JOG_SIZE)
        self._word = self.DeclareVectorInputPort("word", 1)
        self._path = self.DeclareAbstractState(Value(TaughtPath(np.empty((0, 7)))))
        self.DeclareVectorOutputPort("way_back", 8, self._calc_back, {self.abstract_state_ticket(self._path)})
        self.DeclarePeriodicUnrestrictedUpdateEvent(JOYSTICK_PERIOD, 0.0, self._sample)

    @staticmethod
    def AddToBuilder(
        *, builder: DiagramBuilder, X_BT: OutputPort, jog: OutputPort, word: OutputPort, name: str = "recorder"
    ) -> DemonstrationRecorder:
        """Add a recorder to `builder` and connect it.

        Args:
            builder: of the diagram that it is added to.
            X_BT: port with the measured pose of the tool.
            jog: port of the hand.
            word: port of what the person says.
            name: of the system.
        """
        recorder = builder.AddNamedSystem(name, DemonstrationRecorder())
        builder.Connect(X_BT, recorder.GetInputPort("X_BT"))
        builder.Connect(jog, recorder.GetInputPort("jog"))
        builder.Connect(word, recorder.GetInputPort("word"))
        return recorder

    def path(self, root: Context) -> TaughtPath:
        """What was taught, in the context of the diagram that this recorder is in."""
        return self.GetMyContextFromRoot(root).get_abstract_state(int(self._path)).get_value()

    def forget(self, root: Context) -> None:
        """Begin a new demonstration: what was recorded is saved, or not wanted."""
        state = self.GetMyMutableContextFromRoot(root).get_mutable_abstract_state(int(self._path))
        state.set_value(state.get_value().forgotten())

    def _sample(self, context: Context, state: State) -> None:
        value = state.get_mutable_abstract_state(int(self._path))
        word = Word(int(self._word.Eval(context).item(0)))
        pushed = bool(self._jog.Eval(context).any())
        value.set_value(value.get_value().told(word, pushed=pushed).moved(self._X_BT.Eval(context)))

    def _calc_back(self, context: Context, output: BasicVector) -> None:
        path: TaughtPath = context.get_abstract_state(int(self._path)).get_value()
        back = np.zeros(8)
        if path.leads_back and len(path.poses):
            back[0], back[1:] = 1.0, path.poses[-1]
        output.set_value(back)
