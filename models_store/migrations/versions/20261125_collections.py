"""Collections of meshes and retrievals from them

Revision ID: 20261125_collections
Revises: 20261123_classes
Create Date: 2026-11-25 04:50:00
"""

import sqlalchemy as sa
from alembic import op

revision = "20261125_collections"
down_revision = "20261123_classes"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.create_table(
        "collections",
        sa.Column("id", sa.String(length=32), nullable=False),
        sa.Column("job_id", sa.String(length=32), nullable=False),
        sa.Column("name", sa.Text(), nullable=True),
        sa.Column("mesh_ids", sa.JSON(none_as_null=True), nullable=False),
        sa.Column("classifier_id", sa.String(length=32), nullable=False),
        sa.Column("index_key", sa.Text(), nullable=True),
        sa.Column("skipped", sa.JSON(none_as_null=True), nullable=True),
        sa.Column("seconds", sa.Double(), nullable=True),
        sa.Column("created_at", sa.DateTime(timezone=True), nullable=False),
        sa.ForeignKeyConstraint(
            ["classifier_id"], ["classifiers.id"], name=op.f("fk_collections_classifier_id_classifiers")
        ),
        sa.ForeignKeyConstraint(["job_id"], ["jobs.id"], name=op.f("fk_collections_job_id_jobs")),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_collections")),
        sa.UniqueConstraint("job_id", name=op.f("uq_collections_job_id")),
    )
    op.create_index(op.f("ix_collections_classifier_id"), "collections", ["classifier_id"], unique=False)
    op.create_index(op.f("ix_collections_created_at_id"), "collections", ["created_at", "id"], unique=False)
    op.create_table(
        "retrievals",
        sa.Column("id", sa.String(length=32), nullable=False),
        sa.Column("job_id", sa.String(length=32), nullable=False),
        sa.Column("collection_id", sa.String(length=32), nullable=False),
        sa.Column("class_name", sa.Text(), nullable=True),
        sa.Column("model_id", sa.String(length=64), nullable=True),
        sa.Column("mesh_id", sa.String(length=64), nullable=True),
        sa.Column("settings", sa.JSON(none_as_null=True), nullable=False),
        sa.Column("result", sa.JSON(none_as_null=True), nullable=True),
        sa.Column("sheet_key", sa.Text(), nullable=True),
        sa.Column("created_at", sa.DateTime(timezone=True), nullable=False),
        sa.ForeignKeyConstraint(
            ["collection_id"], ["collections.id"], name=op.f("fk_retrievals_collection_id_collections")
        ),
        sa.ForeignKeyConstraint(["job_id"], ["jobs.id"], name=op.f("fk_retrievals_job_id_jobs")),
        sa.ForeignKeyConstraint(["mesh_id"], ["meshes.id"], name=op.f("fk_retrievals_mesh_id_meshes")),
        sa.ForeignKeyConstraint(["model_id"], ["models.id"], name=op.f("fk_retrievals_model_id_models")),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_retrievals")),
        sa.UniqueConstraint("job_id", name=op.f("uq_retrievals_job_id")),
    )
    op.create_index(op.f("ix_retrievals_collection_id"), "retrievals", ["collection_id"], unique=False)
    op.create_index(op.f("ix_retrievals_created_at_id"), "retrievals", ["created_at", "id"], unique=False)
    op.create_index(op.f("ix_retrievals_mesh_id"), "retrievals", ["mesh_id"], unique=False)
    op.create_index(op.f("ix_retrievals_model_id"), "retrievals", ["model_id"], unique=False)


def downgrade() -> None:
    op.drop_table("retrievals")
    op.drop_table("collections")
    ours = "kind IN ('index_collection', 'retrieve')"  # kinds that an older service does not know
    op.execute(f"DELETE FROM job_events WHERE job_id IN (SELECT id FROM jobs WHERE {ours})")
    op.execute(f"DELETE FROM jobs WHERE {ours}")
