"""The run-time type checker of the tests: shapes and types of every public call are checked.

An int may stand for a float, as PEP 484 says.
"""

from beartype import BeartypeConf, beartype

check = beartype(conf=BeartypeConf(is_pep484_tower=True))
