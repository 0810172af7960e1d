"""Classifiers know what is unknown, classifications show what was looked at

Revision ID: 20261125_evidence
Revises: 20261125_collections
Create Date: 2026-11-25 07:20:00
"""

import sqlalchemy as sa
from alembic import op

revision = "20261125_evidence"
down_revision = "20261125_collections"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.add_column("classifiers", sa.Column("negative_model_ids", sa.JSON(none_as_null=True), nullable=True))
    op.add_column("classifiers", sa.Column("exemplars_key", sa.Text(), nullable=True))
    op.add_column("classifications", sa.Column("pictures_key", sa.Text(), nullable=True))


def downgrade() -> None:
    op.drop_column("classifications", "pictures_key")
    op.drop_column("classifiers", "exemplars_key")
    op.drop_column("classifiers", "negative_model_ids")
