"""Estimations of whole collections

Revision ID: 20261126_collection_estimations
Revises: 20261126_estimations
Create Date: 2026-11-26 22:00:00
"""

import sqlalchemy as sa
from alembic import op

revision = "20261126_collection_estimations"
down_revision = "20261126_estimations"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.create_table(
        "collection_estimations",
        sa.Column("id", sa.String(length=32), nullable=False),
        sa.Column("job_id", sa.String(length=32), nullable=False),
        sa.Column("collection_id", sa.String(length=32), nullable=True),
        sa.Column("mesh_ids", sa.JSON(none_as_null=True), nullable=False),
        sa.Column("model_id", sa.String(length=64), nullable=True),
        sa.Column("class_name", sa.Text(), nullable=True),
        sa.Column("model_ids", sa.JSON(none_as_null=True), nullable=False),
        sa.Column("units", sa.String(length=2), nullable=True),
        sa.Column("up", sa.String(length=2), nullable=True),
        sa.Column("settings", sa.JSON(none_as_null=True), nullable=False),
        sa.Column("created_at", sa.DateTime(timezone=True), nullable=False),
        sa.ForeignKeyConstraint(
            ["collection_id"], ["collections.id"], name=op.f("fk_collection_estimations_collection_id_collections")
        ),
        sa.ForeignKeyConstraint(["job_id"], ["jobs.id"], name=op.f("fk_collection_estimations_job_id_jobs")),
        sa.ForeignKeyConstraint(["model_id"], ["models.id"], name=op.f("fk_collection_estimations_model_id_models")),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_collection_estimations")),
        sa.UniqueConstraint("job_id", name=op.f("uq_collection_estimations_job_id")),
    )
    for columns in (["collection_id"], ["created_at", "id"], ["model_id"]):
        name = op.f(f"ix_collection_estimations_{'_'.join(columns)}")
        op.create_index(name, "collection_estimations", columns, unique=False)
    op.create_table(
        "estimated_meshes",
        sa.Column("estimation_id", sa.String(length=32), nullable=False),
        sa.Column("position", sa.Integer(), autoincrement=False, nullable=False),
        sa.Column("mesh_id", sa.String(length=64), nullable=False),
        sa.Column("answer", sa.JSON(none_as_null=True), nullable=True),
        sa.Column("measures", sa.JSON(none_as_null=True), nullable=False),
        sa.Column("error", sa.Text(), nullable=True),
        sa.Column("seconds", sa.Double(), nullable=True),
        sa.Column("created_at", sa.DateTime(timezone=True), nullable=False),
        sa.ForeignKeyConstraint(
            ["estimation_id"],
            ["collection_estimations.id"],
            name=op.f("fk_estimated_meshes_estimation_id_collection_estimations"),
            ondelete="CASCADE",
        ),
        sa.ForeignKeyConstraint(["mesh_id"], ["meshes.id"], name=op.f("fk_estimated_meshes_mesh_id_meshes")),
        sa.PrimaryKeyConstraint("estimation_id", "position", name=op.f("pk_estimated_meshes")),
    )
    op.create_index(op.f("ix_estimated_meshes_mesh_id"), "estimated_meshes", ["mesh_id"], unique=False)


def downgrade() -> None:
    op.drop_table("estimated_meshes")
    op.drop_table("collection_estimations")
    ours = "kind IN ('estimate_collection', 'estimate_meshes')"  # kinds that an older service does not know
    op.execute(f"DELETE FROM job_events WHERE job_id IN (SELECT id FROM jobs WHERE {ours})")
    op.execute(f"DELETE FROM jobs WHERE {ours}")
