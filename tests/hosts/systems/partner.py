"""What second FMUs of the tests share: variables in a dictionary, outputs at the start, states that go back whole."""

import copy
from typing import Any

from pythonfmu import Fmi2Causality, Fmi2Slave, Real


class Partner(Fmi2Slave):
    """A slave whose outputs are found from its inputs at the start and at the end of each step."""

    inputs: tuple[str, ...] = ()
    outputs: tuple[str, ...] = ()

    def __init__(self, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.value = dict.fromkeys((*self.inputs, *self.outputs), 0.0)
        for name in self.value:
            causality = Fmi2Causality.input if name in self.inputs else Fmi2Causality.output
            get = lambda name=name: self.value[name]  # noqa: E731
            put = lambda x, name=name: self.value.__setitem__(name, x)  # noqa: E731
            start = {"start": 0.0} if name in self.inputs else {}
            self.register_variable(Real(name, causality=causality, getter=get, setter=put, **start))

    def find(self, step: float) -> None:
        """Sets the outputs after a step; of length 0 at the start."""
        raise NotImplementedError

    def memory(self) -> Any:
        """What the slave keeps between steps."""
        return None

    def recall(self, memory: Any) -> None:
        """Go back to it."""

    def exit_initialization_mode(self) -> None:
        self.find(0.0)

    def do_step(self, current_time: float, step_size: float) -> bool:
        self.find(step_size)
        return True

    def _get_fmu_state(self) -> dict[str, Any]:
        return {"value": dict(self.value), "memory": copy.deepcopy(self.memory())}

    def _set_fmu_state(self, state: dict[str, Any]) -> None:
        self.value = dict(state["value"])
        self.recall(copy.deepcopy(state["memory"]))
