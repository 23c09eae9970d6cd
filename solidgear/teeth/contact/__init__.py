"""Contact of teeth: cells on the contact lines, what gives way where they touch, and their loads."""
