"""What ships is added to a database once; a classifier that ships has no job

Revision ID: 20261201_shipped
Revises: 20261126_collection_estimations
Create Date: 2026-12-01 05:50:00
"""

import sqlalchemy as sa
from alembic import op

revision = "20261201_shipped"
down_revision = "20261126_collection_estimations"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.create_table(
        "shipped",
        sa.Column("id", sa.String(length=64), nullable=False),
        sa.Column("kind", sa.String(length=16), nullable=False),
        sa.Column("name", sa.Text(), nullable=False),
        sa.Column("created_at", sa.DateTime(timezone=True), nullable=False),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_shipped")),
    )
    _let_job_be_null(True)


def downgrade() -> None:
    without_job = "(SELECT id FROM classifiers WHERE job_id IS NULL)"
    asked_here = f"SELECT id FROM collections WHERE classifier_id IN {without_job}"
    estimations = f"SELECT id FROM collection_estimations WHERE collection_id IN ({asked_here})"
    op.execute(f"DELETE FROM estimated_meshes WHERE estimation_id IN ({estimations})")
    op.execute(f"DELETE FROM collection_estimations WHERE collection_id IN ({asked_here})")
    op.execute(f"DELETE FROM retrievals WHERE collection_id IN ({asked_here})")
    op.execute(f"DELETE FROM collections WHERE classifier_id IN {without_job}")
    op.execute(f"DELETE FROM classifications WHERE classifier_id IN {without_job}")
    op.execute("DELETE FROM classifiers WHERE job_id IS NULL")
    _let_job_be_null(False)
    op.drop_table("shipped")


def _let_job_be_null(nullable: bool) -> None:
    if op.get_bind().dialect.name != "sqlite":
        op.alter_column("classifiers", "job_id", existing_type=sa.String(length=32), nullable=nullable)
        return
    # SQLite changes a column only by making the table anew. Rows of other tables refer to this one: the rows must
    # come back under the table's own name, so that none of those is left without its classifier at the end.
    columns = (
        "id, job_id, name, model_ids, class_names, settings, metrics, onnx_key, seconds, created_at, "
        "negative_model_ids, exemplars_key"
    )
    op.execute("PRAGMA defer_foreign_keys = ON")
    op.execute(f"CREATE TABLE kept_classifiers AS SELECT {columns} FROM classifiers")
    op.drop_table("classifiers")
    op.create_table(
        "classifiers",
        sa.Column("id", sa.String(length=32), nullable=False),
        sa.Column("job_id", sa.String(length=32), nullable=nullable),
        sa.Column("name", sa.Text(), nullable=True),
        sa.Column("model_ids", sa.JSON(none_as_null=True), nullable=False),
        sa.Column("class_names", sa.JSON(none_as_null=True), nullable=False),
        sa.Column("settings", sa.JSON(none_as_null=True), nullable=False),
        sa.Column("metrics", sa.JSON(none_as_null=True), nullable=True),
        sa.Column("onnx_key", sa.Text(), nullable=True),
        sa.Column("seconds", sa.Double(), nullable=True),
        sa.Column("created_at", sa.DateTime(timezone=True), nullable=False),
        sa.Column("negative_model_ids", sa.JSON(none_as_null=True), nullable=True),
        sa.Column("exemplars_key", sa.Text(), nullable=True),
        sa.ForeignKeyConstraint(["job_id"], ["jobs.id"], name=op.f("fk_classifiers_job_id_jobs")),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_classifiers")),
        sa.UniqueConstraint("job_id", name=op.f("uq_classifiers_job_id")),
    )
    op.create_index(op.f("ix_classifiers_created_at_id"), "classifiers", ["created_at", "id"], unique=False)
    op.execute(f"INSERT INTO classifiers ({columns}) SELECT {columns} FROM kept_classifiers")
    op.drop_table("kept_classifiers")
