"""A classifier may extend another one

Revision ID: 20261201_extended
Revises: 20261201_shipped
Create Date: 2026-12-01 11:15:00
"""

import sqlalchemy as sa
from alembic import op

revision = "20261201_extended"
down_revision = "20261201_shipped"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.add_column("classifiers", sa.Column("base_classifier_id", sa.String(length=32), nullable=True))


def downgrade() -> None:
    op.drop_column("classifiers", "base_classifier_id")
