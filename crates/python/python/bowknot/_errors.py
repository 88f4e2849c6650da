"""Exceptions and warnings of the package; their messages are those of the command."""


class BowknotError(Exception):
    """Base of all exceptions of this package."""


class InputError(BowknotError, ValueError):
    """What was given is refused: a scene, a mesh, an array, a parameter, a file."""


class ArrayTypeError(InputError, TypeError):
    """An array has a type of entries that cannot be used."""


class IntersectionError(InputError):
    """A state intersects that must be free of intersections."""


class DeviceError(BowknotError, RuntimeError):
    """There is no such device or driver, or it has failed."""


class InternalError(BowknotError, RuntimeError):
    """A fault of the library itself."""


class BowknotWarning(UserWarning):
    """A result is not to be trusted as it is: time steps that were not solved, targets of a solver that explodes."""
