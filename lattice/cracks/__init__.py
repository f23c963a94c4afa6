"""What a cracked cell carries: layers that fail one after the other, thrust with an arm, friction."""
