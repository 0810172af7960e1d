"""What Alembic runs. The connection comes from ``upgrade``; on the command line it is made from the settings."""

from alembic import context
from sqlalchemy import Connection

from models_store.session import make_engine
from models_store.settings import StoreSettings
from models_store.tables import Base


def _migrate(connection: Connection) -> None:
    context.configure(
        connection=connection,
        target_metadata=Base.metadata,
        transactional_ddl=True,  # SQLite's DDL is transactional once the driver leaves BEGIN to us
        render_as_batch=True,  # SQLite cannot alter most of a table in place
        user_module_prefix="tables.",
    )
    with context.begin_transaction():
        context.run_migrations()


given: Connection | None = context.config.attributes.get("connection")
if given is not None:
    _migrate(given)
else:
    with make_engine(StoreSettings(), pooled=False).begin() as made:
        _migrate(made)
