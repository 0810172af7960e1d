"""The tables. A row is the truth; broker messages and artefacts only point to it or hang on it."""

from datetime import UTC, datetime
from typing import Any

from sqlalchemy import (
    JSON,
    BigInteger,
    DateTime,
    Dialect,
    Double,
    Enum,
    ForeignKey,
    Index,
    MetaData,
    String,
    Text,
    TypeDecorator,
)
from sqlalchemy.orm import DeclarativeBase, Mapped, mapped_column, relationship

from models_store.job_kinds import JobKind, JobState


class UtcDateTime(TypeDecorator[datetime]):
    """An aware time in UTC, in databases with time zones and without."""

    impl = DateTime(timezone=True)
    cache_ok = True

    def process_bind_param(self, value: datetime | None, dialect: Dialect) -> datetime | None:
        """Refuse naive times and convert to UTC."""
        if value is None:
            return None
        if value.tzinfo is None:
            raise ValueError("a time without a zone cannot be stored")
        return value.astimezone(UTC)

    def process_result_value(self, value: datetime | None, dialect: Dialect) -> datetime | None:
        """Give SQLite's naive times back their zone."""
        if value is None:
            return None
        return value.replace(tzinfo=UTC) if value.tzinfo is None else value.astimezone(UTC)


def _words(enum: type[JobKind] | type[JobState]) -> Enum:
    """Store the word itself, so that a new kind or state needs no change of a database type."""
    return Enum(
        enum, native_enum=False, create_constraint=False, length=32, values_callable=lambda e: [m.value for m in e]
    )


class Base(DeclarativeBase):
    """Base of all tables; constraint names are fixed so that migrations can name them."""

    metadata = MetaData(
        naming_convention={
            "ix": "ix_%(table_name)s_%(column_0_N_name)s",
            "uq": "uq_%(table_name)s_%(column_0_N_name)s",
            "ck": "ck_%(table_name)s_%(constraint_name)s",
            "fk": "fk_%(table_name)s_%(column_0_N_name)s_%(referred_table_name)s",
            "pk": "pk_%(table_name)s",
        }
    )
    type_annotation_map = {  # noqa: RUF012 - read by SQLAlchemy at class creation
        datetime: UtcDateTime,
        dict[str, Any]: JSON(none_as_null=True),
        list[Any]: JSON(none_as_null=True),
        list[str]: JSON(none_as_null=True),
        JobKind: _words(JobKind),
        JobState: _words(JobState),
    }


class JobRow(Base):
    """A piece of long work.

    ``token`` is the fencing token: it grows with every claim, and a write that carries an older one is refused.
    ``event_count`` numbers the events of the job without gaps. A row with ``parent_id`` is a part of another job, see
    :mod:`models_store.parts` (no foreign key: SQLite adds none to a table that is there).
    """

    __tablename__ = "jobs"
    __table_args__ = (
        Index(None, "created_at", "id"),
        Index(None, "state", "lease_expires_at"),
        Index(None, "state", "next_wakeup_at"),
        # most jobs have no parent, and each question asks for those: no index on the parent alone
        Index(None, "parent_id", "created_at", "id"),
        Index(None, "parent_id", "state"),
        Index(None, "parent_id", "finished_at"),
    )

    id: Mapped[str] = mapped_column(String(32), primary_key=True)
    parent_id: Mapped[str | None] = mapped_column(String(32))
    kind: Mapped[JobKind]
    state: Mapped[JobState]
    payload: Mapped[dict[str, Any]]
    result_id: Mapped[str] = mapped_column(String(64))
    attempt: Mapped[int]
    max_attempts: Mapped[int]
    token: Mapped[int] = mapped_column(BigInteger)
    event_count: Mapped[int] = mapped_column(BigInteger)
    cancel_requested: Mapped[bool]
    progress_fraction: Mapped[float]
    progress_message: Mapped[str] = mapped_column(Text)
    error_title: Mapped[str | None] = mapped_column(Text)
    error_detail: Mapped[str | None] = mapped_column(Text)
    error_where: Mapped[str | None] = mapped_column(Text)
    worker: Mapped[str | None] = mapped_column(Text)
    created_at: Mapped[datetime]
    started_at: Mapped[datetime | None]
    finished_at: Mapped[datetime | None]
    lease_expires_at: Mapped[datetime | None]
    next_wakeup_at: Mapped[datetime | None]
    wakeup_count: Mapped[int]


class JobEventRow(Base):
    """One entry of a job's replayable stream: ``type`` is ``state`` or ``progress``."""

    __tablename__ = "job_events"

    job_id: Mapped[str] = mapped_column(ForeignKey(JobRow.id, ondelete="CASCADE"), primary_key=True)
    sequence: Mapped[int] = mapped_column(BigInteger, primary_key=True, autoincrement=False)
    type: Mapped[str] = mapped_column(String(16))
    data: Mapped[dict[str, Any]]
    created_at: Mapped[datetime]


class ModelRow(Base):
    """A procedural model; its id is the SHA-256 of its canonical document. Models with one ``class_name`` are a class.

    ``parts`` and ``symmetry`` are null in rows from before models had them.
    """

    __tablename__ = "models"
    __table_args__ = (Index(None, "created_at", "id"), Index(None, "class_name", "name"))

    id: Mapped[str] = mapped_column(String(64), primary_key=True)
    name: Mapped[str] = mapped_column(Text)
    class_name: Mapped[str] = mapped_column(Text)
    description: Mapped[str] = mapped_column(Text)
    closed: Mapped[bool]
    format_version: Mapped[int]
    operation_count: Mapped[int]
    parameters: Mapped[list[Any]]
    parts: Mapped[list[Any] | None]
    symmetry: Mapped[dict[str, Any] | None]
    document: Mapped[str] = mapped_column(Text)
    thumbnail_key: Mapped[str | None] = mapped_column(Text)
    created_at: Mapped[datetime]


class MeshRow(Base):
    """An uploaded mesh; its id is the SHA-256 of the uploaded bytes."""

    __tablename__ = "meshes"
    __table_args__ = (Index(None, "created_at", "id"),)

    id: Mapped[str] = mapped_column(String(64), primary_key=True)
    file_name: Mapped[str] = mapped_column(Text)
    file_type: Mapped[str] = mapped_column(String(8))
    file_size: Mapped[int] = mapped_column(BigInteger)
    vertex_count: Mapped[int]
    face_count: Mapped[int]
    bounds: Mapped[list[Any]]
    watertight: Mapped[bool]
    source_key: Mapped[str] = mapped_column(Text)
    content_key: Mapped[str] = mapped_column(Text)
    created_at: Mapped[datetime]


class ClassifierRow(Base):
    """A classifier: asked for with its job, complete once ``onnx_key`` is set. The one that ships has no job.

    ``negative_model_ids`` and ``exemplars_key`` are null in older rows and in classifiers without them. A classifier
    that extends another one names it in ``base_classifier_id``, and lists the models and classes of both. The column is
    not a foreign key: the base may be deleted once the training has succeeded.
    """

    __tablename__ = "classifiers"
    __table_args__ = (Index(None, "created_at", "id"),)

    id: Mapped[str] = mapped_column(String(32), primary_key=True)
    job_id: Mapped[str | None] = mapped_column(ForeignKey(JobRow.id), unique=True)
    name: Mapped[str | None] = mapped_column(Text)
    base_classifier_id: Mapped[str | None] = mapped_column(String(32))
    model_ids: Mapped[list[str]]
    negative_model_ids: Mapped[list[str] | None]
    class_names: Mapped[list[str]]
    settings: Mapped[dict[str, Any]]
    metrics: Mapped[dict[str, Any] | None]
    onnx_key: Mapped[str | None] = mapped_column(Text)
    exemplars_key: Mapped[str | None] = mapped_column(Text)
    seconds: Mapped[float | None]
    created_at: Mapped[datetime]
    job: Mapped[JobRow | None] = relationship(lazy="joined")

    @property
    def state(self) -> JobState:
        """The state of the training; a classifier that ships is trained."""
        return JobState.SUCCEEDED if self.job is None else self.job.state


class ClassificationRow(Base):
    """What a mesh was taken for; ``result`` and ``pictures_key`` are set once."""

    __tablename__ = "classifications"
    __table_args__ = (Index(None, "created_at", "id"),)

    id: Mapped[str] = mapped_column(String(32), primary_key=True)
    job_id: Mapped[str] = mapped_column(ForeignKey(JobRow.id), unique=True)
    mesh_id: Mapped[str] = mapped_column(ForeignKey(MeshRow.id), index=True)
    classifier_id: Mapped[str] = mapped_column(ForeignKey(ClassifierRow.id), index=True)
    settings: Mapped[dict[str, Any]]
    result: Mapped[dict[str, Any] | None]
    pictures_key: Mapped[str | None] = mapped_column(Text)
    created_at: Mapped[datetime]
    job: Mapped[JobRow] = relationship(lazy="joined", innerjoin=True)


class EstimationRow(Base):
    """Which parameter values rebuild a mesh; ``result`` and the keys are set once.

    Asked for with a class, ``model_ids`` are the models of the class then, and ``model_id`` comes with the result.
    ``units`` and ``up`` say what is known about the coordinates of the mesh; after ``time_limit_s`` the best answer
    until then is taken.
    """

    __tablename__ = "estimations"
    __table_args__ = (Index(None, "created_at", "id"),)

    id: Mapped[str] = mapped_column(String(32), primary_key=True)
    job_id: Mapped[str] = mapped_column(ForeignKey(JobRow.id), unique=True)
    mesh_id: Mapped[str] = mapped_column(ForeignKey(MeshRow.id), index=True)
    model_id: Mapped[str | None] = mapped_column(ForeignKey(ModelRow.id), index=True)
    class_name: Mapped[str | None] = mapped_column(Text)
    model_ids: Mapped[list[str] | None]
    units: Mapped[str | None] = mapped_column(String(2))
    up: Mapped[str | None] = mapped_column(String(2))
    time_limit_s: Mapped[float | None] = mapped_column(Double)
    settings: Mapped[dict[str, Any]]
    result: Mapped[dict[str, Any] | None]
    mesh_key: Mapped[str | None] = mapped_column(Text)
    residuals_key: Mapped[str | None] = mapped_column(Text)
    created_at: Mapped[datetime]
    job: Mapped[JobRow] = relationship(lazy="joined", innerjoin=True)


class CollectionRow(Base):
    """Meshes that are looked through together; ``index_key``, ``skipped`` and ``seconds`` are set once."""

    __tablename__ = "collections"
    __table_args__ = (Index(None, "created_at", "id"),)

    id: Mapped[str] = mapped_column(String(32), primary_key=True)
    job_id: Mapped[str] = mapped_column(ForeignKey(JobRow.id), unique=True)
    name: Mapped[str | None] = mapped_column(Text)
    mesh_ids: Mapped[list[str]]
    classifier_id: Mapped[str] = mapped_column(ForeignKey(ClassifierRow.id), index=True)
    index_key: Mapped[str | None] = mapped_column(Text)
    skipped: Mapped[list[Any] | None]
    seconds: Mapped[float | None]
    created_at: Mapped[datetime]
    job: Mapped[JobRow] = relationship(lazy="joined", innerjoin=True)


class RetrievalRow(Base):
    """Which meshes of a collection come first for a query; ``result`` and ``sheet_key`` are set once.

    Exactly one of ``class_name``, ``model_id`` and ``mesh_id`` is not null.
    """

    __tablename__ = "retrievals"
    __table_args__ = (Index(None, "created_at", "id"),)

    id: Mapped[str] = mapped_column(String(32), primary_key=True)
    job_id: Mapped[str] = mapped_column(ForeignKey(JobRow.id), unique=True)
    collection_id: Mapped[str] = mapped_column(ForeignKey(CollectionRow.id), index=True)
    class_name: Mapped[str | None] = mapped_column(Text)
    model_id: Mapped[str | None] = mapped_column(ForeignKey(ModelRow.id), index=True)
    mesh_id: Mapped[str | None] = mapped_column(ForeignKey(MeshRow.id), index=True)
    settings: Mapped[dict[str, Any]]
    result: Mapped[dict[str, Any] | None]
    sheet_key: Mapped[str | None] = mapped_column(Text)
    created_at: Mapped[datetime]
    job: Mapped[JobRow] = relationship(lazy="joined", innerjoin=True)


class CollectionEstimationRow(Base):
    """Which parameter values rebuild each of many meshes; what is found is in :class:`EstimatedMeshRow`.

    Asked for with a class, ``model_ids`` are the models of the class then, and ``model_id`` is null.
    ``time_limit_s`` is for each mesh.
    """

    __tablename__ = "collection_estimations"
    __table_args__ = (Index(None, "created_at", "id"),)

    id: Mapped[str] = mapped_column(String(32), primary_key=True)
    job_id: Mapped[str] = mapped_column(ForeignKey(JobRow.id), unique=True)
    collection_id: Mapped[str | None] = mapped_column(ForeignKey(CollectionRow.id), index=True)
    mesh_ids: Mapped[list[str]]
    model_id: Mapped[str | None] = mapped_column(ForeignKey(ModelRow.id), index=True)
    class_name: Mapped[str | None] = mapped_column(Text)
    model_ids: Mapped[list[str]]
    units: Mapped[str | None] = mapped_column(String(2))
    up: Mapped[str | None] = mapped_column(String(2))
    time_limit_s: Mapped[float | None] = mapped_column(Double)
    settings: Mapped[dict[str, Any]]
    created_at: Mapped[datetime]
    job: Mapped[JobRow] = relationship(lazy="joined", innerjoin=True)


class EstimatedMeshRow(Base):
    """One mesh of a collection estimation: what was found, or ``error``. Written once, while the job runs.

    ``measures`` are the numbers by which rows are sorted, by column.
    """

    __tablename__ = "estimated_meshes"

    estimation_id: Mapped[str] = mapped_column(
        ForeignKey(CollectionEstimationRow.id, ondelete="CASCADE"), primary_key=True
    )
    position: Mapped[int] = mapped_column(primary_key=True, autoincrement=False)
    mesh_id: Mapped[str] = mapped_column(ForeignKey(MeshRow.id), index=True)
    answer: Mapped[dict[str, Any] | None]
    measures: Mapped[dict[str, Any]]
    error: Mapped[str | None] = mapped_column(Text)
    seconds: Mapped[float | None]
    created_at: Mapped[datetime]


class ShippedRow(Base):
    """A model or classifier that came with a release and was added to this database, perhaps deleted since.

    Its id is the SHA-256 of its content; ``kind`` is ``model`` or ``classifier``. Versions share a ``name``.
    """

    __tablename__ = "shipped"

    id: Mapped[str] = mapped_column(String(64), primary_key=True)
    kind: Mapped[str] = mapped_column(String(16))
    name: Mapped[str] = mapped_column(Text)
    created_at: Mapped[datetime]
