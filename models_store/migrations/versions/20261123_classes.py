"""Classes are sets of models

Revision ID: 20261123_classes
Revises: 20261122_first_tables
Create Date: 2026-11-23 01:45:00
"""

import sqlalchemy as sa
from alembic import op

revision = "20261123_classes"
down_revision = "20261122_first_tables"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.add_column("models", sa.Column("parts", sa.JSON(none_as_null=True), nullable=True))
    op.add_column("models", sa.Column("symmetry", sa.JSON(none_as_null=True), nullable=True))
    op.create_index(op.f("ix_models_class_name_name"), "models", ["class_name", "name"], unique=False)
    with op.batch_alter_table("estimations", schema=None) as batch_op:
        batch_op.alter_column("model_id", existing_type=sa.String(length=64), nullable=True)
        batch_op.add_column(sa.Column("class_name", sa.Text(), nullable=True))
        batch_op.add_column(sa.Column("model_ids", sa.JSON(none_as_null=True), nullable=True))


def downgrade() -> None:
    op.execute("DELETE FROM estimations WHERE model_id IS NULL")
    with op.batch_alter_table("estimations", schema=None) as batch_op:
        batch_op.drop_column("model_ids")
        batch_op.drop_column("class_name")
        batch_op.alter_column("model_id", existing_type=sa.String(length=64), nullable=False)
    op.drop_index(op.f("ix_models_class_name_name"), table_name="models")
    op.drop_column("models", "symmetry")
    op.drop_column("models", "parts")
