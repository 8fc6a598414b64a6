"""PythonFMU imports this file at each instantiation and makes an instance of the class below."""

from PackageName.slave import Slave


class ModelName(Slave):
    """The slave under the name of its FMU."""

    # PythonFMU releases this module's globals once per instance; a function of its own holds them.
    def __init__(self, **kwargs):
        super().__init__(**kwargs)
