"""Jobs have parts that other workers may take

Revision ID: 20261125_parts
Revises: 20261125_evidence
Create Date: 2026-11-25 09:10:00
"""

import sqlalchemy as sa
from alembic import op

revision = "20261125_parts"
down_revision = "20261125_evidence"
branch_labels = None
depends_on = None

INDEXES = (["parent_id", "created_at", "id"], ["parent_id", "state"], ["parent_id", "finished_at"])


def upgrade() -> None:
    op.add_column("jobs", sa.Column("parent_id", sa.String(length=32), nullable=True))
    for columns in INDEXES:
        op.create_index(op.f(f"ix_jobs_{'_'.join(columns)}"), "jobs", columns, unique=False)


def downgrade() -> None:
    op.execute("DELETE FROM jobs WHERE parent_id IS NOT NULL")  # an older service does not know their kind
    for columns in INDEXES:
        op.drop_index(op.f(f"ix_jobs_{'_'.join(columns)}"), table_name="jobs")
    op.drop_column("jobs", "parent_id")
