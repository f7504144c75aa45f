"""The answer of :meth:`pliant.Scene.optimize`."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Optimum:
    """The best numbers of a scene: in words (`text`, printed), and as `data`, with the keys of optimum.json.

    `values` are the numbers by their keys, as :meth:`pliant.Scene.with_values` takes them.
    """

    text: str
    data: dict

    def __str__(self):
        return self.text

    values = property(lambda self: self._of_numbers("value"), doc="The best numbers, by their keys.")
    before = property(lambda self: self._of_quantities("before"), doc="The quantities with the numbers of the scene, by their names.")
    after = property(lambda self: self._of_quantities("after"), doc="The quantities with the best numbers, by their names.")
    is_optimum = property(lambda self: self.data["is_optimum"], doc="Whether the search came to an optimum.")

    @property
    def bounds(self):
        """The ends of their ranges, ``"least"`` or ``"most"``, that numbers are at, by their keys."""
        return {key: at for key, at in self._of_numbers("at").items() if at}

    def _of_numbers(self, word):
        return {key: one[word] for key, one in self.data["numbers"].items()}

    def _of_quantities(self, word):
        return {one["of"]: one[word] for one in self.data["of"]}
